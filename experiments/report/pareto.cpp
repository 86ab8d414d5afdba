#include "experiments/report/pareto.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/measure/samples_file.hpp"

namespace experiments::report {
namespace {

using measure::MetricSummary;
using measure::ResultSummary;

/// `a` is nowhere worse than `b` and somewhere better.
bool dominates(const Tradeoff& a, const Tradeoff& b) {
    const double time = a.milliseconds.median - b.milliseconds.median, error = a.errors - b.errors;
    return time <= 0 && error <= 0 && (time < 0 || error < 0);
}

}  // namespace

std::vector<Tradeoff> find_tradeoffs(std::span<const ResultSummary> results) {
    std::vector<Tradeoff> list;
    for (const ResultSummary& result : results) {
        const MetricSummary* time = result.find("total_ms");
        const MetricSummary* errors = result.find("errors_per_million");
        if (time && errors)
            list.push_back({&result, time->statistics, errors->statistics.median,
                            result.median("claims_exact") != 0});
    }
    for (Tradeoff& one : list)
        one.front = std::none_of(list.begin(), list.end(),
                                 [&](const Tradeoff& other) { return dominates(other, one); });
    return list;
}

std::string pareto_csv(std::span<const Tradeoff> tradeoffs) {
    if (tradeoffs.empty()) return {};
    std::string csv =
        "scene,method,variant,total_ms,errors_per_million,false_lit,false_shadowed,points,"
        "claims_exact,on_front\n";
    for (const Tradeoff& one : tradeoffs) {
        const ResultSummary& result = *one.result;
        csv += fmt::format("{},{},{},{},{},{},{},{},{:d},{:d}\n", measure::csv_field(result.scene),
                           measure::csv_field(result.method), measure::csv_field(result.variant),
                           one.milliseconds.median, one.errors, result.median("false_lit"),
                           result.median("false_shadowed"), result.median("points"),
                           one.claims_exact, one.front);
    }
    return csv;
}

}  // namespace experiments::report
