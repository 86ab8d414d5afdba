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

ClusterConfig cluster_config(const Settings& settings);
BuildConfig build_config(const Settings& settings);
/// None unless `build` names a CPU builder.
std::optional<ReferenceConfig> reference_config(const Settings& settings);

}  // namespace structures::metric_tree
