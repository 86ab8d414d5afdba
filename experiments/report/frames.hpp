// Time along a path: how long each method takes in which frame.
//
//     html += frame_chart("city", find_curves(rows, "city"));
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/measure/samples_file.hpp"

namespace experiments::report {

/// One method's total_ms along the path.
struct Curve {
    std::string label;
    std::vector<int> frames;
    std::vector<double> milliseconds;  ///< of each of them, median over repetitions
};

/// Those of the methods of `scene`, in order of first appearance; empty if it has one frame.
std::vector<Curve> find_curves(std::span<const measure::Row> rows, const std::string& scene);

/// total_ms against the frame as inline SVG, from 0, a line per curve; at least one.
std::string frame_chart(const std::string& title, std::span<const Curve> curves);

}  // namespace experiments::report
