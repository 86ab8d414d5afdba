// The CPU builder and the checks; reference.hpp describes them.
#include "structures/ball_tree/reference.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "structures/violations.hpp"

namespace structures::ball_tree {
namespace {

float distance_squared(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

glm::vec3 centroid(const geometry::TriangleMesh& mesh, std::size_t triangle) {
    const float third = 1.0f / 3.0f;
    return mesh.corner(triangle, 0) * third + mesh.corner(triangle, 1) * third +
           mesh.corner(triangle, 2) * third;
}

/// A range of points that becomes the subtree below `node`.
struct Range {
    std::uint32_t node, begin, end, depth;
};

/// Moves the points that go left to the front, in order; returns where the others begin. Must agree
/// with split_of() in build.comp.
std::uint32_t split(std::vector<BallPoint>& points, const Range& range, const geometry::Aabb& box) {
    const std::uint32_t count = range.end - range.begin;
    const glm::vec3 extent = box.extent();
    if (range.depth + std::bit_width(count) >= kMaxDepth || extent == glm::vec3(0))
        return range.begin + count / 2;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    float position = box.center()[axis];
    if (position >= box.upper[axis]) position = box.lower[axis];
    const auto middle = std::stable_partition(
        points.begin() + range.begin, points.begin() + range.end,
        [&](const BallPoint& point) { return point.position[axis] <= position; });
    return static_cast<std::uint32_t>(middle - points.begin());
}

class Validator : Violations {
  public:
    Validator(const geometry::TriangleMesh& mesh, const Tree& tree, std::uint32_t leaf_size)
        : mesh_(mesh), tree_(tree), leaf_size_(leaf_size) {}

    std::vector<std::string> run() {
        const BallNode& root = tree_.nodes[0];
        if (root.count > 0 || root.first > 0) check_nodes();
        std::size_t expected = 0;
        for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) expected += !mesh_.degenerate(i);
        if (held_ != expected || tree_.points.size() != expected)
            fail("{} points of which {} in leaves, for {} triangles that are not degenerate",
                 tree_.points.size(), held_, expected);
        check_points();
        return take_lines();
    }

  private:
    void check_nodes() {
        std::vector<bool> reached(tree_.nodes.size());
        std::vector<Range> stack{{0, 0, static_cast<std::uint32_t>(tree_.points.size()), 0}};
        reached[0] = true;
        while (!stack.empty()) {
            const Range range = stack.back();
            stack.pop_back();
            const BallNode& node = tree_.nodes[range.node];
            if (range.depth > kMaxDepth) fail("node {}: deeper than {}", range.node, kMaxDepth);
            if (node.count > 0) {
                check_leaf(range, node);
                continue;
            }
            // Children are numbered by where their range is split.
            const std::uint32_t middle = (node.first + 1) / 2;
            if (middle <= range.begin || middle >= range.end ||
                std::size_t{node.first} + 1 >= tree_.nodes.size() || reached[node.first] ||
                reached[node.first + 1]) {
                fail("node {}: children at {} are out of range or reached twice", range.node,
                     node.first);
                continue;
            }
            check_ball(range, node);
            reached[node.first] = reached[node.first + 1] = true;
            stack.push_back({node.first, range.begin, middle, range.depth + 1});
            stack.push_back({node.first + 1, middle, range.end, range.depth + 1});
        }
    }

    void check_ball(const Range& range, const BallNode& node) {
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            if (!(distance_squared(node.center, tree_.points[i].position) <= node.radius_squared))
                fail("node {}: point {} lies outside the ball", range.node, i);
    }

    void check_leaf(const Range& range, const BallNode& leaf) {
        if (leaf.first != range.begin || leaf.count != range.end - range.begin) {
            fail("leaf {}: points {} to {} are not its range {} to {}", range.node, leaf.first,
                 std::uint64_t{leaf.first} + leaf.count, range.begin, range.end);
            return;
        }
        held_ += leaf.count;
        check_ball(range, leaf);
        if (leaf.count <= leaf_size_) return;
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            if (tree_.points[i].position != tree_.points[range.begin].position)
                fail("leaf {}: more than {} points that differ", range.node, leaf_size_);
    }

    void check_points() {
        std::vector<bool> seen(mesh_.triangle_count());
        for (const BallPoint& point : tree_.points) {
            if (point.id >= seen.size() || seen[point.id] || mesh_.degenerate(point.id)) {
                fail("triangle {}: does not exist, is degenerate, or comes twice", point.id);
                continue;
            }
            seen[point.id] = true;
            if (point.position != centroid(mesh_, point.id))
                fail("triangle {}: its point is not its centroid", point.id);
        }
    }

    const geometry::TriangleMesh& mesh_;
    const Tree& tree_;
    std::uint32_t leaf_size_;
    std::size_t held_ = 0;
};

}  // namespace

Tree build_reference(const geometry::TriangleMesh& mesh, std::uint32_t leaf_size) {
    Tree tree;
    for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i)
        if (!mesh.degenerate(i)) tree.points.push_back({centroid(mesh, i), i});
    const auto count = static_cast<std::uint32_t>(tree.points.size());
    tree.nodes.resize(std::max(2 * std::size_t{count}, std::size_t{1}));
    std::vector<Range> stack;
    if (count > 0) stack.push_back({0, 0, count, 0});
    while (!stack.empty()) {
        const Range range = stack.back();
        stack.pop_back();
        geometry::Aabb box;
        for (std::uint32_t i = range.begin; i < range.end; ++i) box.grow(tree.points[i].position);
        BallNode& node = tree.nodes[range.node];
        node = {box.center(), 0, range.begin, range.end - range.begin};
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            node.radius_squared = std::max(node.radius_squared,
                                           distance_squared(node.center, tree.points[i].position));
        if (node.count <= leaf_size || box.lower == box.upper) continue;
        const std::uint32_t middle = split(tree.points, range, box);
        node.first = 2 * middle - 1;
        node.count = 0;
        stack.push_back({node.first, range.begin, middle, range.depth + 1});
        stack.push_back({node.first + 1, middle, range.end, range.depth + 1});
    }
    return tree;
}

std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Tree& tree,
                                  std::uint32_t leaf_size) {
    return Validator(mesh, tree, leaf_size).run();
}

Nearest nearest_of_all(std::span<const BallPoint> points, glm::vec3 query) {
    Nearest best{kNoPoint, std::numeric_limits<float>::infinity()};
    for (const BallPoint& point : points) {
        const float d = distance_squared(query, point.position);
        if (d < best.distance_squared || best.id == kNoPoint) best = {point.id, d};
    }
    return best;
}

}  // namespace structures::ball_tree
