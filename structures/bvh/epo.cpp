// EPO by walking the tree once with every triangle; see epo.hpp.
#include "structures/bvh/epo.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <array>

namespace structures::bvh {
namespace {

using geometry::Aabb;

/// A triangle clipped by six planes has at most nine corners.
struct Polygon {
    std::array<glm::dvec3, 9> corners;
    int count = 0;

    double area() const {
        glm::dvec3 sum(0);
        for (int i = 2; i < count; ++i)
            sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        return 0.5 * glm::length(sum);
    }
};

/// Sutherland-Hodgman against one plane: keeps sign * (p[axis] - plane) >= 0. New corners get the
/// plane's coordinate exactly, so clipping at the same plane again changes nothing.
Polygon clip(const Polygon& in, int axis, double plane, double sign) {
    Polygon out;
    for (int i = 0; i < in.count; ++i) {
        const glm::dvec3& a = in.corners[i];
        const glm::dvec3& b = in.corners[i + 1 == in.count ? 0 : i + 1];
        const double da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
        if (da >= 0) out.corners[out.count++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            glm::dvec3 p = a + (b - a) * (da / (da - db));
            p[axis] = plane;
            out.corners[out.count++] = p;
        }
    }
    return out;
}

bool overlap(const Aabb& a, const BvhNode& b) {
    return glm::all(glm::lessThanEqual(a.lower, b.upper)) &&
           glm::all(glm::lessThanEqual(b.lower, a.upper));
}

/// When a walk enters a node and how many it has entered before leaving it: node m lies in the
/// subtree of n iff enter[n] <= enter[m] < leave[n].
struct Intervals {
    std::vector<std::uint32_t> enter, leave;       ///< by node
    std::vector<std::uint32_t> leaf_of_primitive;  ///< enter[] of the leaf
};

Intervals intervals_of(const geometry::TriangleMesh& mesh, const Tree& tree) {
    Intervals at;
    at.enter.resize(tree.nodes.size());
    at.leave.resize(tree.nodes.size());
    at.leaf_of_primitive.resize(mesh.triangle_count());
    std::vector<std::uint32_t> preorder;
    walk(tree, [&](std::uint32_t id, std::uint32_t) {
        const BvhNode& node = tree.nodes[id];
        at.enter[id] = static_cast<std::uint32_t>(preorder.size());
        at.leave[id] = at.enter[id] + 1;
        for (std::uint32_t i = 0; i < node.count; ++i)
            at.leaf_of_primitive[tree.order[node.first + i]] = at.enter[id];
        preorder.push_back(id);
    });
    for (auto id = preorder.rbegin(); id != preorder.rend(); ++id) {
        const BvhNode& node = tree.nodes[*id];
        if (node.count == 0) at.leave[*id] = at.leave[node.first + 1];
    }
    return at;
}

}  // namespace

double clipped_area(const glm::dvec3 (&corners)[3], const Aabb& box) {
    Polygon polygon;
    for (const glm::dvec3& corner : corners) polygon.corners[polygon.count++] = corner;
    for (int axis = 0; axis < 3; ++axis) {
        polygon = clip(polygon, axis, box.lower[axis], 1);
        polygon = clip(polygon, axis, box.upper[axis], -1);
    }
    return polygon.area();
}

double end_point_overlap(const geometry::TriangleMesh& mesh, const Tree& tree,
                         const CostModel& costs) {
    const Intervals at = intervals_of(mesh, tree);
    struct Sums {
        double weighted = 0, total = 0;
    };
    const auto add_triangles = [&](const tbb::blocked_range<std::size_t>& range, Sums sums) {
        std::vector<std::uint32_t> stack;
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::uint32_t id = tree.order[i];
            const Aabb bounds = mesh.triangle_bounds(id);
            const glm::dvec3 corners[3] = {mesh.corner(id, 0), mesh.corner(id, 1),
                                           mesh.corner(id, 2)};
            sums.total +=
                0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
            const std::uint32_t home = at.leaf_of_primitive[id];
            stack.assign(1, 0);
            while (!stack.empty()) {
                const std::uint32_t node_id = stack.back();
                stack.pop_back();
                const BvhNode& node = tree.nodes[node_id];
                if (!overlap(bounds, node)) continue;
                const bool belongs = at.enter[node_id] <= home && home < at.leave[node_id];
                if (!belongs) {
                    const double area = clipped_area(corners, box_of(node));
                    if (!(area > 0)) continue;
                    sums.weighted +=
                        area * (node.count > 0 ? costs.intersection * node.count : costs.traversal);
                }
                if (node.count == 0) {
                    stack.push_back(node.first);
                    stack.push_back(node.first + 1);
                }
            }
        }
        return sums;
    };
    const auto join = [](Sums a, Sums b) {
        return Sums{a.weighted + b.weighted, a.total + b.total};
    };
    const Sums sums = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, tree.order.size(), 1024), Sums{}, add_triangles, join);
    return sums.total > 0 ? sums.weighted / sums.total : 0;
}

}  // namespace structures::bvh
