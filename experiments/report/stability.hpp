// The report's page of a run of the stress suite.
#pragma once

#include <span>
#include <string>

#include "experiments/measure/summary.hpp"

namespace experiments::report {

/// The coloured matrix of tests and methods.
std::string stability_section(std::span<const measure::ResultSummary> results);

}  // namespace experiments::report
