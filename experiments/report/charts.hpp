// Bar charts as inline SVG, coloured by the page's style sheet.
#pragma once

#include <span>
#include <string>

#include "experiments/measure/statistics.hpp"

namespace experiments::report {

struct Bar {
    std::string label;
    measure::Statistics statistics;
};

/// Horizontal bars from 0 to the medians, each with a line from minimum to maximum and, thicker,
/// the confidence interval. Bars share one scale. At least one bar; values must not be negative.
std::string bar_chart(const std::string& title, const std::string& unit, std::span<const Bar> bars);

}  // namespace experiments::report
