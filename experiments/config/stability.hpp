// The keys of [experiment] that only kind = "stability" takes.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/config/table.hpp"

namespace experiments::config {

struct Stability {
    std::vector<int> tests{};  ///< numbers, ascending
    int transforms = 10;       ///< random rigid transforms of each scene
    int orders = 10;           ///< random orders of its triangles
    std::vector<double> scales{1e-4, 1e-2, 1e2, 1e4};
};

/// Reads `tests`, `transforms`, `orders` and `scales`, all optional.
Stability read_stability(Table& table);

nlohmann::json to_json(const Stability& stability);

}  // namespace experiments::config
