#include "experiments/report/pareto.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/measure/samples_file.hpp"

namespace experiments::report {
namespace {

using measure::MetricSummary;
using measure::ResultSummary;

double median(const ResultSummary& result, const char* metric) {
    const MetricSummary* summary = result.find(metric);
    return summary ? summary->statistics.median : 0;
}

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
                            median(result, "claims_exact") != 0});
    }
    for (Tradeoff& one : list)
        one.front = std::none_of(list.begin(), list.end(),
                                 [&](const Tradeoff& other) { return dominates(other, one); });
    return list;
}

std::string pareto_csv(std::span<const ResultSummary> results) {
    std::vector<std::vector<ResultSummary>> scenes;
    for (const ResultSummary& result : results) {
        const auto same = [&](const auto& list) { return list.front().scene == result.scene; };
        const auto scene = std::find_if(scenes.begin(), scenes.end(), same);
        scene == scenes.end() ? scenes.push_back({result}) : scene->push_back(result);
    }
    std::string rows;
    for (const std::vector<ResultSummary>& scene : scenes)
        for (const Tradeoff& one : find_tradeoffs(scene))
            rows += fmt::format(
                "{},{},{},{},{},{},{},{},{:d},{:d}\n", measure::csv_field(one.result->scene),
                measure::csv_field(one.result->method), measure::csv_field(one.result->variant),
                one.milliseconds.median, one.errors, median(*one.result, "false_lit"),
                median(*one.result, "false_shadowed"), median(*one.result, "points"),
                one.claims_exact, one.front);
    if (rows.empty()) return rows;
    return "scene,method,variant,total_ms,errors_per_million,false_lit,false_shadowed,points,"
           "claims_exact,on_front\n" +
           rows;
}

}  // namespace experiments::report
