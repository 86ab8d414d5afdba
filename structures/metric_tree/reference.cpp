// From the top down: a pivot, every other element's reach from it, a delta, three subtrees.
//
// Pivot: P. N. Yianilos, "Data Structures and Algorithms for Nearest Neighbor Search in General
// Metric Spaces", 1993: of a few sampled candidates the one whose distances to a second sample
// spread widest about their median. Delta: J. K. Uhlmann, "Satisfying general proximity /
// similarity queries with metric trees", 1991: the median distance.
//
// Cost of a delta: queries that come to a node are taken to lie like the middles of its elements.
// A subtree costs the share of them that its bounds let in, times the elements in it to the power
// kCostPower; an overlapping one, which lies in a shell and not in a ball, kOverFactor as much.
// Both were found by trial, with queries of what a camera sees (Sponza, Sibenik): powers below 1
// end in long chains of overlapping subtrees. Candidates for delta are quantiles of lo, hi and
// middle, on a sample; the pivot of Split::cost is that of the candidates whose best delta costs
// least.
#include "structures/metric_tree/reference.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include "structures/metric_tree/metric.hpp"
#include "structures/metric_tree/rounding.hpp"

namespace structures::metric_tree {
namespace {

constexpr std::size_t kPivotCandidates = 8, kPivotSample = 32, kCostSample = 128, kQuantiles = 8;
constexpr double kCostPower = 1.2, kOverFactor = 1.5;
/// Pivots tried before what is left becomes a list, and how many it takes for one.
constexpr int kTries = 3;
constexpr std::size_t kListAtLeast = 8;

/// Elements still to be linked as one subtree.
struct Range {
    std::uint32_t begin, end;
    std::uint32_t* link;  // to be set to the subtree's root
    std::uint32_t ancestor, depth;
};

struct Placed {
    std::uint32_t id;
    Reach reach;
};

enum Part { part_near, part_far, part_over };
Part part_of(const Reach& reach, double delta) {
    return reach.high <= delta ? part_near : reach.low > delta ? part_far : part_over;
}

/// Bounds of three parts, as MetricNode holds them.
struct Bounds {
    double near_max = -1, far_min = std::numeric_limits<double>::infinity();
    double over_min = std::numeric_limits<double>::infinity(), over_max = 0;
    std::array<std::size_t, 3> counts{};

    void take(const Reach& reach, Part part) {
        ++counts[part];
        if (part == part_near) near_max = std::max(near_max, reach.high);
        if (part == part_far) far_min = std::min(far_min, reach.low);
        if (part == part_over) {
            over_min = std::min(over_min, reach.low);
            over_max = std::max(over_max, reach.high);
        }
    }
};

double cost_of(const std::vector<Placed>& placed, double delta) {
    Bounds bounds;
    for (const Placed& p : placed) bounds.take(p.reach, part_of(p.reach, delta));
    std::array<std::size_t, 3> entering{};
    for (const Placed& p : placed) {
        const double d = p.reach.middle;
        entering[part_near] += d <= bounds.near_max;
        entering[part_far] += d >= bounds.far_min;
        entering[part_over] += d >= bounds.over_min && d <= bounds.over_max;
    }
    const auto subtree = [&](Part part) {
        return double(entering[part]) * std::pow(double(bounds.counts[part]), kCostPower);
    };
    return subtree(part_near) + subtree(part_far) + kOverFactor * subtree(part_over);
}

double median_of(const std::vector<Placed>& placed) {
    std::vector<double> middles(placed.size());
    std::transform(placed.begin(), placed.end(), middles.begin(),
                   [](const Placed& p) { return p.reach.middle; });
    const auto half = middles.begin() + middles.size() / 2;
    std::nth_element(middles.begin(), half, middles.end());
    return *half;
}

struct Choice {
    double delta, cost;
};

Choice cheapest(const std::vector<Placed>& placed) {
    Choice best{0, std::numeric_limits<double>::infinity()};
    std::vector<double> values(placed.size());
    for (const auto member : {&Reach::low, &Reach::high, &Reach::middle}) {
        for (std::size_t i = 0; i < placed.size(); ++i) values[i] = placed[i].reach.*member;
        std::sort(values.begin(), values.end());
        for (std::size_t k = 0; k < kQuantiles; ++k) {
            const double delta = values[(2 * k + 1) * values.size() / (2 * kQuantiles)];
            const double cost = cost_of(placed, delta);
            if (cost < best.cost) best = {delta, cost};
        }
    }
    return best;
}

class Builder {
  public:
    Builder(Tree& tree, std::vector<std::uint32_t> ids, const ReferenceConfig& config)
        : tree_(tree),
          config_(config),
          directional_(tree.header.frame.directional != 0),
          ids_(std::move(ids)),
          elements_(tree.nodes.size()) {
        for (const std::uint32_t id : ids_) elements_[id] = element_of(tree.nodes[id]);
    }

    void run() {
        if (ids_.empty()) return;
        const Range all{0, static_cast<std::uint32_t>(ids_.size()), &tree_.header.root, 0, 1};
        tbb::parallel_for_each(&all, &all + 1, [&](const Range& range, auto& feeder) {
            link(range, [&](const Range& part) { feeder.add(part); });
        });
        tree_.header.bucketed = listed_;
        tree_.header.depth_max = depth_max_;
    }

  private:
    using Random = std::mt19937_64;

    template <typename Emit>
    void link(const Range& range, const Emit& emit) {
        std::uint32_t* const ids = ids_.data() + range.begin;
        const std::size_t others = range.end - range.begin - 1;
        Random random(config_.seed + (std::uint64_t{range.begin} << 32 | range.end));
        std::vector<Placed> placed;
        double delta = 0;
        for (int attempt = 0; attempt < kTries; ++attempt) {
            std::swap(ids[choose_pivot(range, random)], ids[0]);
            placed = place(ids[0], ids + 1, others);
            if (others == 0) break;
            if (config_.split == Split::cost) {
                delta = cheapest(sample(placed, random)).delta;
                if (others < kListAtLeast || progresses(placed, delta)) break;
            }
            delta = median_of(placed);
            if (others < kListAtLeast || progresses(placed, delta)) break;
            if (attempt + 1 == kTries) return make_list(range);
        }
        divide(range, placed, delta, emit);
    }

    /// Whether every part is smaller than the whole by enough to bound the depth.
    static bool progresses(const std::vector<Placed>& placed, double delta) {
        std::array<std::size_t, 3> counts{};
        for (const Placed& p : placed) ++counts[part_of(p.reach, delta)];
        const std::size_t largest = *std::max_element(counts.begin(), counts.end());
        return largest + std::max<std::size_t>(placed.size() / 32, 1) <= placed.size();
    }

    template <typename Emit>
    void divide(const Range& range, std::vector<Placed>& placed, double delta, const Emit& emit) {
        std::uint32_t* const ids = ids_.data() + range.begin;
        reach_depth(range.depth);
        MetricNode& node = begin_node(range);
        Bounds bounds;
        for (const Placed& p : placed) bounds.take(p.reach, part_of(p.reach, delta));
        std::array<std::uint32_t, 3> begin{range.begin + 1}, next;
        begin[1] = begin[0] + static_cast<std::uint32_t>(bounds.counts[0]);
        begin[2] = begin[1] + static_cast<std::uint32_t>(bounds.counts[1]);
        next = begin;
        for (const Placed& p : placed) ids_[next[part_of(p.reach, delta)]++] = p.id;
        node.near_max = rounded_up(bounds.near_max);
        node.far_min = rounded_down(bounds.far_min);
        node.over_min = rounded_down(bounds.over_min);
        node.over_max = rounded_up(bounds.over_max);
        const std::array<std::uint32_t*, 3> links{&node.near, &node.far, &node.over};
        for (int k = 0; k < 3; ++k)
            if (next[k] > begin[k])
                emit(Range{begin[k], next[k], links[k],
                           k == part_over ? ids[0] + 1 : range.ancestor, range.depth + 1});
    }

    /// Sets the link to the range's first element, whose subtree the range is.
    MetricNode& begin_node(const Range& range) {
        const std::uint32_t id = ids_[range.begin];
        MetricNode& node = tree_.nodes[id];
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            node.min_depth = std::min(node.min_depth, tree_.nodes[ids_[i]].min_depth);
        node.ancestor = range.ancestor;
        *range.link = id + 1;
        return node;
    }

    /// A chain of overlapping subtrees, from the least depth to the greatest, so that a query
    /// leaves it where its own is reached.
    void make_list(const Range& range) {
        std::sort(ids_.begin() + range.begin, ids_.begin() + range.end,
                  [&](std::uint32_t x, std::uint32_t y) {
                      const float dx = tree_.nodes[x].min_depth, dy = tree_.nodes[y].min_depth;
                      return dx != dy ? dx < dy : x < y;
                  });
        std::uint32_t* link = range.link;
        std::uint32_t ancestor = range.ancestor;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            const std::uint32_t id = ids_[i];
            MetricNode& node = tree_.nodes[id];
            node.ancestor = ancestor;
            ancestor = *link = id + 1;
            link = &node.over;
            if (i + 1 < range.end) {
                node.over_min = 0;
                node.over_max = std::numeric_limits<float>::max();
            }
        }
        listed_ += range.end - range.begin;
    }

    void reach_depth(std::uint32_t depth) {
        std::uint32_t old = depth_max_;
        while (old < depth && !depth_max_.compare_exchange_weak(old, depth)) {
        }
    }

    std::vector<Placed> place(std::uint32_t pivot, const std::uint32_t* ids, std::size_t count) {
        std::vector<Placed> placed(count);
        for (std::size_t i = 0; i < count; ++i)
            placed[i] = {ids[i], reach_of(directional_, elements_[pivot], elements_[ids[i]])};
        return placed;
    }

    static std::vector<Placed> sample(const std::vector<Placed>& placed, Random& random) {
        if (placed.size() <= kCostSample) return placed;
        std::vector<Placed> chosen(kCostSample);
        for (Placed& p : chosen) p = placed[random() % placed.size()];
        return chosen;
    }

    /// Place of the pivot in the range.
    std::size_t choose_pivot(const Range& range, Random& random) {
        const std::uint32_t* const ids = ids_.data() + range.begin;
        const std::size_t count = range.end - range.begin;
        if (count <= 2) return random() % count;
        const bool by_cost = config_.split == Split::cost;
        std::vector<std::uint32_t> others(
            std::min(by_cost ? kCostSample / 2 : kPivotSample, count));
        for (std::uint32_t& other : others) other = ids[random() % count];
        std::size_t best = 0;
        double best_merit = -std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < std::min(kPivotCandidates, count); ++k) {
            const std::size_t candidate = random() % count;
            const auto placed = place(ids[candidate], others.data(), others.size());
            const double merit = by_cost ? -cheapest(placed).cost : spread_of(placed);
            if (merit > best_merit) best = candidate, best_merit = merit;
        }
        return best;
    }

    /// Second moment of the distances about their median.
    static double spread_of(const std::vector<Placed>& placed) {
        const double median = median_of(placed);
        double sum = 0;
        for (const Placed& p : placed) sum += (p.reach.middle - median) * (p.reach.middle - median);
        return sum;
    }

    Tree& tree_;
    const ReferenceConfig& config_;
    bool directional_;
    std::vector<std::uint32_t> ids_;  // of elements; those of one subtree are neighbours
    std::vector<Element> elements_;   // as the nodes hold them
    std::atomic<std::uint32_t> listed_{0}, depth_max_{0};
};

}  // namespace

Tree build_reference(const Clustering& clustering, const geometry::Aabb& bounds,
                     const geometry::Light& light, const ReferenceConfig& config) {
    const auto count = static_cast<std::uint32_t>(clustering.clusters.size());
    Tree tree{};
    MetricHeader& header = tree.header;
    header.frame = make_frame(light, bounds);
    header.cluster_count = count;
    tree.nodes.resize(count);
    std::vector<Role> roles(count);
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t id) {
        Element element{};
        double min_depth = 0;
        roles[id] = make_element(header.frame, clustering.clusters[id], config.cull_facing, element,
                                 min_depth);
        tree.nodes[id] = make_node(element, min_depth);
    });
    std::vector<std::uint32_t> ids;
    for (std::uint32_t id = 0; id < count; ++id) {
        if (roles[id] == Role::element) ids.push_back(id);
        if (roles[id] == Role::special) tree.special.push_back(id);
        if (roles[id] == Role::faces_away) ++header.culled_facing;
    }
    header.special_count = static_cast<std::uint32_t>(tree.special.size());
    header.inserted = static_cast<std::uint32_t>(ids.size());
    Builder(tree, std::move(ids), config).run();
    return tree;
}

}  // namespace structures::metric_tree
