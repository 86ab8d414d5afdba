// grove compare
#include <fmt/format.h>

#include <cmath>

#include "experiments/commands/program.hpp"
#include "experiments/measure/metrics.hpp"
#include "experiments/measure/summary.hpp"

namespace experiments::commands {
namespace {

using measure::MetricSummary;
using measure::ResultSummary;
using Results = std::vector<ResultSummary>;

Results read_summary(const std::string& run) {
    const std::filesystem::path file = std::filesystem::path(run) / "summary.json";
    return measure::from_json(measure::read_json(file), file.string());
}

const ResultSummary* find_same(const Results& results, const ResultSummary& wanted) {
    for (const ResultSummary& result : results)
        if (result.scene == wanted.scene && result.method == wanted.method &&
            result.variant == wanted.variant)
            return &result;
    return nullptr;
}

/// How much worse `b` is than `a`, in percent of `a`; negative if better, 0 if neither is.
double worsening(const MetricSummary& a, const MetricSummary& b) {
    const measure::Metric* metric = measure::find_metric(a.metric);
    if (!metric || metric->better == measure::Better::neither) return 0;
    double change = b.statistics.median - a.statistics.median;
    if (metric->better == measure::Better::higher) change = -change;
    if (change == 0) return 0;
    if (a.statistics.median == 0) return change > 0 ? INFINITY : -INFINITY;
    return 100 * change / std::abs(a.statistics.median);
}

std::string with_spread(const MetricSummary& summary) {
    const auto& s = summary.statistics;
    std::string median = measure::readable(s.median, summary.unit);
    if (s.min == s.max) return median;
    return fmt::format("{} [{}, {}]", median, measure::readable(s.ci_low, summary.unit),
                       measure::readable(s.ci_high, summary.unit));
}

std::string change_text(const MetricSummary& a, const MetricSummary& b) {
    const double from = a.statistics.median, to = b.statistics.median;
    if (from == to) return "=";
    return from == 0 ? "from 0" : fmt::format("{:+.1f} %", 100 * (to - from) / std::abs(from));
}

/// The medians' confidence intervals share a value.
bool overlap(const MetricSummary& a, const MetricSummary& b) {
    return a.statistics.ci_low <= b.statistics.ci_high &&
           b.statistics.ci_low <= a.statistics.ci_high;
}

}  // namespace

int compare(const std::string& run_a, const std::string& run_b, double limit_percent) {
    const Results a = read_summary(run_a), b = read_summary(run_b);
    std::vector<std::vector<std::string>> rows{
        {"scene", "method", "variant", "metric", "A", "B", "change", ""}};
    int over = 0;
    const auto limited = [&](bool exceeded) {
        if (limit_percent < 0 || !exceeded) return std::string();
        ++over;
        return std::string("  over the limit");
    };
    for (const ResultSummary& result : a) {
        const ResultSummary* other = find_same(b, result);
        for (const MetricSummary& metric : result.metrics) {
            auto& row = rows.emplace_back(std::vector<std::string>{
                result.scene, result.method, result.variant, metric.metric, with_spread(metric)});
            const MetricSummary* mate = other ? other->find(metric.metric) : nullptr;
            // What the scene itself took (its G-buffer) is no result that could get worse.
            const bool counts = result.method != measure::kSceneRows;
            if (!mate) {
                row.insert(row.end(), {"-", "missing", limited(counts)});
                continue;
            }
            const double worse = worsening(metric, *mate);
            std::string note = worse == 0               ? ""
                               : overlap(metric, *mate) ? "within the spread"
                               : worse < 0              ? "better"
                                                        : "worse";
            note += limited(counts && worse > limit_percent);
            row.insert(row.end(), {with_spread(*mate), change_text(metric, *mate), note});
        }
    }
    for (const ResultSummary& result : b)
        if (!find_same(a, result))
            rows.push_back({result.scene, result.method, result.variant, "", "-", "only in B"});
    fmt::print("{}", text_table(rows, 4));
    if (over > 0)
        throw std::runtime_error(fmt::format(
            "{} of B's metrics are worse than A's by more than {} %", over, limit_percent));
    return 0;
}

}  // namespace experiments::commands
