// Figures of merit of a BVH.
//
//     Quality quality = measure(mesh, tree);
//     Samples rows = to_samples(quality);   // sah_cost, epo, depth_max, ...
#pragma once

#include <cstdint>

#include "structures/bvh/tree.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "structures/sample.hpp"

namespace structures::bvh {

struct Quality {
    /// Sum over inner nodes of c_T A(n) / A(root) plus over leaves of c_I count A(n) / A(root).
    double sah_cost = 0;
    /// The same after turning every subtree into one leaf (of any size) where that is cheaper.
    double sah_cost_compacted = 0;
    double epo = 0;               ///< see epo.hpp
    std::uint32_t depth_max = 0;  ///< of a leaf; the root has depth 0
    double depth_mean = 0;        ///< over leaves
    double leaf_size_mean = 0;    ///< primitives per leaf
    std::uint32_t nodes = 0;      ///< reached from the root
    bool operator==(const Quality&) const = default;
};

struct MeasureOptions {
    CostModel costs;
    bool epo =
        true;  ///< the one figure that takes longer than a walk: seconds per million triangles
};

/// Measures a valid tree. All zero for an empty one.
Quality measure(const geometry::TriangleMesh& mesh, const Tree& tree,
                const MeasureOptions& options = {});

/// One sample per figure, under the names of the metric list.
Samples to_samples(const Quality& quality);

}  // namespace structures::bvh
