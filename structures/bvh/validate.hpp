// Checks every invariant of a BVH.
//
//     for (const std::string& violation : validate(mesh, tree, {.max_leaf_size = 4})) ...
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "structures/bvh/tree.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace structures::bvh {

struct Limits {
    std::uint32_t max_leaf_size = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t max_depth = std::numeric_limits<std::uint32_t>::max();  ///< the root has depth 0
    bool tight = false;  ///< boxes must equal the union of what they hold, not just contain it
};

/// Walks from the root over any array of nodes, however broken, and returns one line per violation;
/// after twenty, only how many more there are. Empty: the tree is valid.
///
/// Checked: links and leaf ranges in range, no node reached twice (cycles, shared subtrees), boxes
/// inside their parents' and around their primitives, every non-degenerate primitive in exactly one
/// leaf, degenerate ones in none, `order` without unused entries, and the limits.
std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Tree& tree,
                                  const Limits& limits);

}  // namespace structures::bvh
