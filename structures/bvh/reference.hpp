// CPU builders of binary BVHs: slow, plain and careful, the yardstick of the GPU builds.
//
//     ReferenceConfig config;                         // full sweep SAH, leaves of at most 4
//     config.rule = SplitRule::object_median;
//     Tree tree = build_reference(mesh, config);
//
// All rules keep three lists of the primitives, sorted once by the x, y and z coordinate of their
// box centres (ties by id); a split is a position in one list, and partitioning the others stably
// keeps them sorted (Wald and Havran 2006, "On building fast kd-trees for ray tracing, and on doing
// that in O(N log N)"). Equal inputs give equal trees, whatever the number of threads.
#pragma once

#include <cstdint>

#include "structures/bvh/tree.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace structures::bvh {

enum class SplitRule {
    sweep_sah,       ///< the cheapest of all positions in all three lists
    object_median,   ///< half of the primitives, along the longest axis of their centres' bounds
    spatial_median,  ///< the middle of that axis; the object median where it separates nothing
};

enum class LeafRule {
    sah,    ///< n <= max_leaf_size, and a leaf costs no more than the rule's split
    count,  ///< n <= max_leaf_size
};

struct ReferenceConfig {
    SplitRule rule = SplitRule::sweep_sah;
    LeafRule leaf_rule = LeafRule::sah;
    std::uint32_t max_leaf_size = 4;
    CostModel costs;
    /// No leaf lies deeper (root: 0): a range that could not otherwise be finished in time is split
    /// at the object median from there on. At least ceil(log2(triangles)) for the promise to hold.
    std::uint32_t max_depth = 64;
    unsigned threads = 0;  ///< at most all cores; 0: all of them
    bool operator==(const ReferenceConfig&) const = default;
};

/// Builds over the non-degenerate triangles of `mesh`; its nodes have no holes and lie in preorder
/// of sibling pairs. Throws std::invalid_argument if max_leaf_size is 0.
Tree build_reference(const geometry::TriangleMesh& mesh, const ReferenceConfig& config);

}  // namespace structures::bvh
