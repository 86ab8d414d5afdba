// A BVH on the host: what a CPU builder returns and what a GPU build reads back.
//
//     Tree tree = build_reference(mesh, {});
//     walk(tree, [&](std::uint32_t node, std::uint32_t depth) { ... });  // reached nodes, preorder
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "structures/bvh/bvh_shared.h"
#include "structures/geometry/aabb.hpp"

namespace structures::bvh {

/// `order` holds primitive ids in leaf order; degenerate primitives are absent from it, so a mesh
/// had triangle_count() - order.size() of them. `nodes` is never empty: see bvh_shared.h for the
/// empty tree.
struct Tree {
    std::vector<BvhNode> nodes;
    std::vector<std::uint32_t> order;

    bool empty() const { return nodes[0].count == 0 && nodes[0].first == 0; }
};

/// Relative costs of the surface area heuristic: visiting an inner node, testing a primitive.
struct CostModel {
    double traversal = 3;
    double intersection = 2;
    bool operator==(const CostModel&) const = default;
};

inline geometry::Aabb box_of(const BvhNode& node) { return {node.lower, node.upper}; }

/// Half the surface area in double precision: boxes up to the largest float do not overflow.
inline double half_area(const geometry::Aabb& box) {
    if (box.empty()) return 0;
    const glm::dvec3 e = glm::dvec3(box.upper) - glm::dvec3(box.lower);
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

/// Calls `visit(node, depth)` for every node of a valid tree, parents first, left before right; the
/// root has depth 0. An empty tree has no nodes to visit.
template <typename Visit>
void walk(const Tree& tree, Visit&& visit) {
    if (tree.empty()) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [node, depth] = stack.back();
        stack.pop_back();
        visit(node, depth);
        if (tree.nodes[node].count > 0) continue;
        stack.emplace_back(tree.nodes[node].first + 1, depth + 1);
        stack.emplace_back(tree.nodes[node].first, depth + 1);
    }
}

}  // namespace structures::bvh
