// The keys of [experiment] that only kind = "stability" takes.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/config/table.hpp"
#include "experiments/stability/variations.hpp"

namespace experiments::config {

/// Reads `tests`, `transforms`, `orders` and `scales`, all optional.
stability::Selection read_stability(Table& table);

nlohmann::json to_json(const stability::Selection& selection);

}  // namespace experiments::config
