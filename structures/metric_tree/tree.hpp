// A ternary metric tree on the host.
#pragma once

#include <string>
#include <vector>

#include "structures/metric_tree/clustering.hpp"

namespace structures::metric_tree {

struct Tree {
    MetricHeader header;
    std::vector<MetricNode> nodes;       ///< one per cluster; those of no element are not linked
    std::vector<std::uint32_t> special;  ///< clusters that every query has to look at
};

struct TreeQuality {
    std::uint32_t nodes = 0, depth_max = 0;
    double depth_mean = 0;
};
TreeQuality measure(const Tree& tree);

/// One line per violation, whatever the bytes: every element linked exactly once and no other
/// cluster; ancestors as documented; and each bound of each node holding for all elements that it
/// speaks of, by distances in double precision.
std::vector<std::string> validate(const Clustering& clustering, const Tree& tree);

}  // namespace structures::metric_tree
