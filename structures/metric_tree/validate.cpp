// Checks of metric trees that share no formula with their builders: points of elements and of
// clusters are taken, and what queries there need is demanded of every bound on their way.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "structures/metric_tree/metric.hpp"
#include "structures/metric_tree/tree.hpp"
#include "structures/violations.hpp"

namespace structures::metric_tree {
namespace {

using glm::dvec3;
constexpr std::uint32_t kNone = 0xffffffffu;
/// Distances that a query computes are off by less.
constexpr double kQueryError = 0.25 * kMetricError;

enum Side : std::uint8_t { side_near, side_far, side_over };
constexpr std::array<const char*, 3> kSideNames{"near", "far", "over"};

std::array<std::uint32_t, 3> links_of(const MetricNode& node) {
    return {node.near, node.far, node.over};
}

/// How nodes hang together; bounded work whatever the links say.
struct Shape {
    std::vector<std::uint32_t> preorder, parent, depth;  // depth 0: not linked
    std::vector<Side> side;                              // of the parent
};

template <typename Bad>  // called with the node that links and the link
Shape walk(const Tree& tree, const Bad& bad) {
    Shape shape;
    const std::size_t count = tree.nodes.size();
    shape.parent.assign(count, kNone);
    shape.depth.assign(count, 0);
    shape.side.assign(count, side_near);
    struct Entry {
        std::uint32_t link, parent;
        Side side;
    };
    std::vector<Entry> stack;
    if (tree.header.root != 0) stack.push_back({tree.header.root, kNone, side_near});
    while (!stack.empty()) {
        const Entry entry = stack.back();
        stack.pop_back();
        const std::uint32_t id = entry.link - 1;
        if (entry.link > kLinkMask || id >= count || shape.depth[id] != 0) {
            bad(entry.parent, entry.link);
            continue;
        }
        shape.preorder.push_back(id);
        shape.parent[id] = entry.parent;
        shape.side[id] = entry.side;
        shape.depth[id] = entry.parent == kNone ? 1 : shape.depth[entry.parent] + 1;
        const auto links = links_of(tree.nodes[id]);
        for (int k = 3; k-- > 0;)
            if (links[k] != 0) stack.push_back({links[k], id, static_cast<Side>(k)});
    }
    return shape;
}

double angle(const dvec3& p, const dvec3& q) {
    return std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
}

/// Distances by other ways than metric.glsl's: by the plane of the arc.
class Geometry {
  public:
    explicit Geometry(bool directional) : directional_(directional) {}

    double distance(const dvec3& p, const dvec3& q) const {
        return directional_ ? glm::length(p - q) : angle(p, q);
    }

    dvec3 nearest(const dvec3& p, const Element& arc) const {
        const dvec3 e = arc.b - arc.a;
        if (arc.a == arc.b) return arc.a;
        if (directional_) {
            if (glm::dot(p - arc.a, e) <= 0) return arc.a;
            if (glm::dot(p - arc.b, e) >= 0) return arc.b;
            return arc.a + e * (glm::dot(p - arc.a, e) / glm::dot(e, e));
        }
        const dvec3 normal = glm::normalize(glm::cross(arc.a, e));
        const dvec3 foot = p - normal * glm::dot(p, normal);
        if (glm::dot(glm::cross(arc.a, foot), normal) > 0 &&
            glm::dot(glm::cross(foot, arc.b), normal) > 0)
            return glm::normalize(foot);
        return distance(p, arc.a) <= distance(p, arc.b) ? arc.a : arc.b;
    }

    /// From `from` straight away from `pole` by `way`; back towards it where that is negative.
    dvec3 moved(const dvec3& from, const dvec3& pole, double way) const {
        dvec3 along = from - pole;
        if (!directional_) along -= from * (glm::dot(along, from) / glm::dot(from, from));
        if (!(glm::dot(along, along) > 1e-24)) along = any_across(from);
        along = glm::normalize(along);
        if (directional_) return from + along * way;
        return glm::normalize(from) * std::cos(way) + along * std::sin(way);
    }

  private:
    dvec3 any_across(const dvec3& p) const {
        if (directional_) return {1, 0, 0};
        return glm::cross(p, std::abs(p.x) < std::abs(p.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0));
    }

    bool directional_;
};

class Validator : Violations {
  public:
    Validator(const Clustering& clustering, const Tree& tree)
        : clusters_(clustering.clusters),
          tree_(tree),
          frame_(tree.header.frame),
          geometry_(tree.header.frame.directional != 0) {}

    std::vector<std::string> run() {
        if (tree_.nodes.size() != clusters_.size()) {
            fail("{} nodes for {} clusters", tree_.nodes.size(), clusters_.size());
        } else {
            shape_ = walk(tree_, [&](std::uint32_t parent, std::uint32_t link) {
                if (parent == kNone)
                    fail("the root link {} is none", link);
                else
                    fail("node {}: link {} is none or leads to a node linked already", parent,
                         link);
            });
            check_membership();
            check_counts();
            check_ancestors();
            check_depths();
            tbb::parallel_for(std::size_t{0}, shape_.preorder.size(),
                              [&](std::size_t i) { check_element(shape_.preorder[i]); });
            find_demanding();
            tbb::parallel_for(std::size_t{0}, shape_.preorder.size(),
                              [&](std::size_t i) { check_bounds(shape_.preorder[i]); });
        }
        return take_lines();
    }

  private:
    bool linked(std::uint32_t id) const { return shape_.depth[id] != 0; }

    void check_membership() {
        std::vector<std::uint8_t> special(clusters_.size());
        for (const std::uint32_t id : tree_.special) {
            if (id >= special.size())
                fail("special cluster {} is none", id);
            else if (std::exchange(special[id], 1))
                fail("cluster {} is listed as special twice", id);
            else if (linked(id))
                fail("cluster {} is both special and linked", id);
        }
        for (std::uint32_t id = 0; id < clusters_.size(); ++id)
            if (!linked(id) && special[id] == 0) {
                ++left_out_;
                if (!faces_away(clusters_[id]))
                    fail("cluster {} is not linked, nor special, and does not face away", id);
            }
    }

    void check_counts() {
        const MetricHeader& header = tree_.header;
        const auto equal = [&](const char* what, std::size_t said, std::size_t is) {
            if (said != is) fail("header: {} is {}, not {}", what, is, said);
        };
        equal("cluster_count", header.cluster_count, clusters_.size());
        equal("special_count", header.special_count, tree_.special.size());
        equal("inserted", header.inserted, shape_.preorder.size());
        equal("culled clusters", header.culled_facing + header.culled_unseen, left_out_);
        std::uint32_t depth = 0;
        for (const std::uint32_t d : shape_.depth) depth = std::max(depth, d);
        // Nodes in lists do not count as depth.
        if (header.depth_max > depth || depth > std::uint64_t{header.depth_max} + header.bucketed)
            fail("header: depth_max is {} without {} elements in lists, not {} with them",
                 header.depth_max, header.bucketed, depth);
        if (header.bucketed > header.inserted)
            fail("header: {} elements in lists of {} inserted", header.bucketed, header.inserted);
    }

    void check_ancestors() {
        for (const std::uint32_t id : shape_.preorder) {
            const std::uint32_t parent = shape_.parent[id];
            const std::uint32_t is = parent == kNone                ? 0
                                     : shape_.side[id] == side_over ? parent + 1
                                                                    : tree_.nodes[parent].ancestor;
            if (tree_.nodes[id].ancestor != is)
                fail("node {}: ancestor is {}, not {}", id, tree_.nodes[id].ancestor, is);
        }
    }

    /// Where the points of a cluster are: its segment's points, the nearest to the light among
    /// them.
    std::array<dvec3, 6> axis_points(const Cluster& cluster) const {
        const dvec3 a = cluster.a, e = dvec3(cluster.b) - a;
        double nearest = 0;
        if (frame_.directional == 0 && glm::dot(e, e) > 0)
            nearest = std::clamp(glm::dot(dvec3(frame_.origin) - a, e) / glm::dot(e, e), 0.0, 1.0);
        std::array<dvec3, 6> points;
        for (int k = 0; k < 5; ++k) points[k] = a + e * (0.25 * k);
        points[5] = a + e * nearest;
        return points;
    }

    void check_depths() {
        std::vector<double> least(clusters_.size());
        for (std::size_t i = shape_.preorder.size(); i-- > 0;) {
            const std::uint32_t id = shape_.preorder[i];
            double depth = std::numeric_limits<double>::infinity();
            for (const dvec3& point : axis_points(clusters_[id]))
                depth = std::min(depth, depth_of(frame_, point));
            depth -= double{clusters_[id].radius} * frame_.scale;
            for (const std::uint32_t link : links_of(tree_.nodes[id]))
                if (link - 1 < clusters_.size() && shape_.parent[link - 1] == id)
                    depth = std::min(depth, least[link - 1]);
            least[id] = depth;
            const double bound = tree_.nodes[id].min_depth;
            if (!(bound >= 0 && bound <= std::max(depth, 0.0)))
                fail("node {}: min_depth is {}, but its subtree begins at depth {}", id, bound,
                     depth);
        }
    }

    /// Points of the cluster's volume are seen where the node says.
    void check_element(std::uint32_t id) {
        const Cluster& cluster = clusters_[id];
        const MetricNode& node = tree_.nodes[id];
        const Element element = element_of(node);
        const double radius = double{cluster.radius} * frame_.scale;
        double stray = 0;
        for (const dvec3& point : axis_points(cluster)) {
            const dvec3 center = seen(frame_, point);
            // The most that a ball extends is where rays touch it; both ways along the arc, and
            // both across.
            double extent = radius;
            if (frame_.directional == 0) {
                if (!(glm::length(center) > radius)) {
                    fail("node {}: the light is in its cluster", id);
                    return;
                }
                extent = std::asin(radius / glm::length(center));
            }
            const dvec3 across = frame_.directional != 0 ? dvec3(0, 0, 1) : center;
            const dvec3 side = glm::cross(across, element.b - element.a);
            for (const dvec3& pole :
                 {element.a, element.b, center + side, center - side, center + dvec3(1, 0, 0)})
                stray = std::max(stray,
                                 distance_to_arc(geometry_.moved(center, pole, extent), element));
        }
        if (!(stray + kQueryError <= node.radius))
            fail("node {}: its cluster is seen up to {} from the arc, past the radius {}", id,
                 stray, node.radius);
        if (frame_.directional == 0 &&
            !(angle(element.a, element.b) <= 0.5 * std::numbers::pi + kMetricError &&
              node.radius <= kWidestElement + kMetricError))
            fail("node {}: its element is too wide, it ought to be special", id);
    }

    double distance_to_arc(const dvec3& p, const Element& arc) const {
        return geometry_.distance(p, geometry_.nearest(p, arc));
    }

    /// Whether every normal in the cone leads away from the light, at each of many points of the
    /// cluster.
    bool faces_away(const Cluster& cluster) const {
        if (!(cluster.cone_cosine > 0)) return false;
        const double left = std::asin(std::min(double{cluster.cone_cosine}, 1.0));
        if (frame_.directional != 0) return angle(cluster.axis, frame_.forward) < left;
        const double radius = double{cluster.radius} * frame_.scale;
        for (const dvec3& point : axis_points(cluster)) {
            const dvec3 center = seen(frame_, point);
            if (!(glm::length(center) > radius)) return false;
            if (!(angle(cluster.axis, center) + std::asin(radius / glm::length(center)) < left))
                return false;
        }
        return true;
    }

    /// Whether some query must not take this link: a list's links are always taken.
    bool demands(std::uint32_t parent, Side side) const {
        const MetricNode& node = tree_.nodes[parent];
        const double any = frame_.directional != 0 ? 1e6 : std::numbers::pi + kMetricError;
        if (side == side_near) return !(node.near_max >= any);
        if (side == side_far) return !(node.far_min <= 0);
        return !(node.over_min <= 0 && node.over_max >= any);
    }

    void find_demanding() {
        demanding_.assign(clusters_.size(), kNone);
        for (const std::uint32_t id : shape_.preorder) {
            const std::uint32_t parent = shape_.parent[id];
            if (parent != kNone)
                demanding_[id] = demands(parent, shape_.side[id]) ? id : demanding_[parent];
        }
    }

    /// The bounds on the way to a node: the nearest, and of those above ever fewer.
    void check_bounds(std::uint32_t id) {
        constexpr std::uint32_t kAllOf = 128, kStepsAtMost = 4096;
        std::uint32_t below = demanding_[id];
        for (std::uint32_t steps = 0; below != kNone && steps < kStepsAtMost; ++steps) {
            const std::uint32_t parent = shape_.parent[below];
            if (steps < kAllOf || (steps * 0x9e3779b9u + id) % steps < kAllOf)
                check_bound(id, parent, shape_.side[below]);
            below = demanding_[parent];
        }
    }

    void check_bound(std::uint32_t id, std::uint32_t parent, Side side) {
        const MetricNode& node = tree_.nodes[parent];
        const Element pivot = element_of(node), element = element_of(tree_.nodes[id]);
        double low = std::numeric_limits<double>::infinity(), high = 0;
        const auto take = [&](const dvec3& point) {
            const double distance = distance_to_arc(point, pivot);
            low = std::min(low, distance);
            high = std::max(high, distance);
        };
        const int steps = element.a == element.b ? 0 : 4;
        for (int k = 0; k <= steps; ++k) {
            const dvec3 center = element.a + (element.b - element.a) * (0.25 * k);
            const dvec3 pole = geometry_.nearest(center, pivot);
            const double distance = geometry_.distance(center, pole);
            take(geometry_.moved(center, pole, element.radius));
            take(geometry_.moved(center, pole, -std::min<double>(element.radius, distance)));
        }
        low = std::max(low - kQueryError, 0.0);
        high += kQueryError;
        const bool holds = side == side_near  ? high <= node.near_max
                           : side == side_far ? low >= node.far_min
                                              : low >= node.over_min && high <= node.over_max;
        if (!holds)
            fail("node {}: queries between {} and {} need element {} in its {} subtree", parent,
                 low, high, id, kSideNames[side]);
    }

    const std::vector<Cluster>& clusters_;
    const Tree& tree_;
    const LightFrame& frame_;
    Geometry geometry_;
    Shape shape_;
    std::vector<std::uint32_t> demanding_;  // nearest at or above a node whose link demands
    std::size_t left_out_ = 0;
};

}  // namespace

TreeQuality measure(const Tree& tree) {
    const Shape shape = walk(tree, [](std::uint32_t, std::uint32_t) {});
    TreeQuality quality;
    quality.nodes = static_cast<std::uint32_t>(shape.preorder.size());
    double sum = 0;
    for (const std::uint32_t id : shape.preorder) {
        quality.depth_max = std::max(quality.depth_max, shape.depth[id]);
        sum += shape.depth[id];
    }
    if (quality.nodes > 0) quality.depth_mean = sum / quality.nodes;
    return quality;
}

std::vector<std::string> validate(const Clustering& clustering, const Tree& tree) {
    return Validator(clustering, tree).run();
}

}  // namespace structures::metric_tree
