// The names a measured number may carry, with unit, meaning and which direction is better.
#pragma once

#include <span>
#include <string_view>

namespace experiments::measure {

enum class Better { lower, higher, neither };

struct Metric {
    std::string_view name;
    std::string_view unit;
    Better better;
    std::string_view meaning;
};

/// Closes a repetition in samples.csv; no measurement, so absent from metrics() and summaries.
inline constexpr std::string_view kComplete = "complete";

std::span<const Metric> metrics();
/// The metric of that name, or nullptr: methods may measure more than the list knows.
const Metric* find_metric(std::string_view name);

}  // namespace experiments::measure
