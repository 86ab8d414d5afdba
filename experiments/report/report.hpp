// report.html: a run as one page that needs nothing else, no network, no script.
#pragma once

#include <filesystem>
#include <span>

#include "experiments/measure/summary.hpp"

namespace experiments::report {

/// (Re)makes report.html in a run's folder from samples.csv, manifest.json and images/; and, if
/// answers were judged, pareto.csv and a plot of run time against error in images/. Throws
/// std::runtime_error naming the file that is missing or unreadable.
void write_report(const std::filesystem::path& run);
/// The same with the rows of samples.csv and what they were summarised to.
void write_report(const std::filesystem::path& run, std::span<const measure::Row> rows,
                  std::span<const measure::ResultSummary> results);

}  // namespace experiments::report
