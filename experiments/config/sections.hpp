// The [[scene]] and [[method]] sections of a config.
#pragma once

#include "experiments/config/config.hpp"

namespace experiments::config {

/// Appends what one [[scene]] stands for: one scene, or one per combination of its lists and per
/// view of its file of views when no view is named. Generators that take a `seed` get `seed` unless
/// the table has its own.
void read_scenes(const Node& node, const Catalogue& catalogue, std::int64_t seed,
                 std::vector<Scene>& scenes);

/// Appends what one [[method]] stands for. `what` is what `entries` are, for messages.
void read_methods(const Node& node, const Entries& entries, const std::string& what,
                  std::vector<Method>& methods);

}  // namespace experiments::config
