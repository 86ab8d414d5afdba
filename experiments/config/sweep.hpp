// Sweeps: a list where a single value is expected stands for every one of its values in turn.
#pragma once

#include <string>
#include <vector>

#include "experiments/config/node.hpp"

namespace experiments::config {

/// One combination of a table's swept keys.
struct Combination {
    Node table;                      ///< without lists where single values belong
    std::vector<std::string> swept;  ///< the keys that were lists
};

/// Every combination of the lists in `table`, the last key varying fastest. `list_key` expects a
/// list by itself, so only a list of lists sweeps it. Fails on an empty list.
std::vector<Combination> expand(const Node& table, std::string_view list_key = {});

/// "key=value,key=value" of the swept keys named in `swept`.
std::string sweep_label(const Combination& combination, const std::vector<std::string>& except);

}  // namespace experiments::config
