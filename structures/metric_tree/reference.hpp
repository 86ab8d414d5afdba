// Metric trees built on the CPU with care: what the builds on the device are compared with.
#pragma once

#include "structures/geometry/light.hpp"
#include "structures/metric_tree/tree.hpp"

namespace structures::metric_tree {

enum class Split {
    median,  ///< pivot after Yianilos 1993, delta the median distance of the elements' middles
             ///< (Uhlmann 1991)
    cost,    ///< delta of least expected cost among quantiles of the elements' distances
};

struct ReferenceConfig {
    Split split = Split::median;
    bool cull_facing = false;
    std::uint64_t seed = 1;
};

/// The tree of all clusters as `light` sees them; `bounds` are the mesh's.
Tree build_reference(const Clustering& clustering, const geometry::Aabb& bounds,
                     const geometry::Light& light, const ReferenceConfig& config = {});

}  // namespace structures::metric_tree
