// The ball tree on the CPU: the same construction, one range after the other; what a tree must
// satisfy; and the nearest point by looking at all of them.
//
//     Tree expected = build_reference(mesh, 8);
//     for (const std::string& violation : validate(mesh, tree, 8)) ...
#pragma once

#include <span>
#include <string>
#include <vector>

#include "structures/ball_tree/ball_tree.hpp"

namespace structures::ball_tree {

/// Equal to a GPU build in everything that validate() and walk() see.
Tree build_reference(const geometry::TriangleMesh& mesh, std::uint32_t leaf_size);

/// One line per violation, of the first twenty. Checked, from the root: links and ranges in range,
/// no node reached twice, every point in exactly one leaf, points are the centroids of exactly the
/// triangles that are not degenerate, balls hold their points, leaf sizes, depth.
std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Tree& tree,
                                  std::uint32_t leaf_size);

/// The nearest of `points`, by the same float arithmetic as query.glsl.
Nearest nearest_of_all(std::span<const BallPoint> points, glm::vec3 query);

/// Calls `visit(node, depth)` for every node of a valid tree, parents first, left before right.
template <typename Visit>
void walk(const Tree& tree, Visit&& visit) {
    if (tree.nodes[0].count == 0 && tree.nodes[0].first == 0) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [id, depth] = stack.back();
        stack.pop_back();
        visit(tree.nodes[id], depth);
        if (tree.nodes[id].count > 0) continue;
        stack.emplace_back(tree.nodes[id].first + 1, depth + 1);
        stack.emplace_back(tree.nodes[id].first, depth + 1);
    }
}

}  // namespace structures::ball_tree
