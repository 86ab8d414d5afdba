// What a config may say about metric trees, for the structure and for shadow methods that build
// one.
#pragma once

#include <optional>
#include <vector>

#include "structures/metric_tree/build.hpp"
#include "structures/metric_tree/reference.hpp"
#include "structures/parameters.hpp"

namespace structures::metric_tree {

/// `build`, `cluster_size`, `capsules`, `cull_facing`, `seed`, and those of the pool.
std::vector<Parameter> tree_parameters();

/// The clusters of `mesh` as the settings want them, made on the CPU or on the device.
Clustering make_clusters(taskpool::gpu::Device& device, const geometry::TriangleMesh& mesh,
                         const Settings& settings);
BuildConfig build_config(const Settings& settings);
/// None unless `build` names a CPU builder.
std::optional<ReferenceConfig> reference_config(const Settings& settings);

}  // namespace structures::metric_tree
