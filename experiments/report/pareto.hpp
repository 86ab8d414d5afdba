// Run time against error: which method, at which setting, is worth its time.
//
//     std::vector<Tradeoff> tradeoffs = find_tradeoffs(results_of_one_scene);
//     html += pareto_chart("city", tradeoffs);
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/measure/summary.hpp"

namespace experiments::report {

/// One method at one setting on one scene.
struct Tradeoff {
    const measure::ResultSummary* result = nullptr;
    measure::Statistics milliseconds;  ///< total_ms
    double errors = 0;                 ///< errors_per_million, median
    bool claims_exact = false;
    /// On the Pareto front: no other is as fast and as accurate, and better in one of the two.
    bool front = false;
};

/// Those of one scene's `results` that have both numbers, in their order. They point into it.
std::vector<Tradeoff> find_tradeoffs(std::span<const measure::ResultSummary> results);

/// total_ms against errors_per_million as inline SVG, both logarithmic, no error at a mark of its
/// own below them. A mark per entry, the front joined by a staircase; at least one entry.
std::string pareto_chart(const std::string& title, std::span<const Tradeoff> tradeoffs);

/// As CSV, a line per entry, of one scene or more; empty if there is none.
std::string pareto_csv(std::span<const Tradeoff> tradeoffs);

}  // namespace experiments::report
