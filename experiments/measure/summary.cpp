#include "experiments/measure/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace experiments::measure {
namespace {

std::string with_separators(double value) {
    std::string digits = fmt::format("{:.0f}", value);
    for (int i = int(digits.size()) - 3; i > (digits[0] == '-' ? 1 : 0); i -= 3)
        digits.insert(i, 1, ',');
    return digits;
}

/// About four significant digits, no exponent.
std::string four_digits(double value) {
    const double size = std::abs(value);
    return size >= 1000 ? with_separators(value)
                        : fmt::format("{:.{}f}", value,
                                      size >= 100  ? 1
                                      : size >= 10 ? 2
                                                   : 3);
}

/// A number of summary.json; JSON has no NaN and writes null.
double number(const nlohmann::json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

}  // namespace

const MetricSummary* ResultSummary::find(std::string_view metric) const {
    for (const MetricSummary& summary : metrics)
        if (summary.metric == metric) return &summary;
    return nullptr;
}

double ResultSummary::median(std::string_view metric) const {
    const MetricSummary* summary = find(metric);
    return summary ? summary->statistics.median : 0;
}

std::string ResultSummary::label() const {
    return variant == "default" ? method : method + " " + variant;
}

std::vector<ResultSummary> summarise(std::span<const Row> rows) {
    std::vector<ResultSummary> results;
    std::vector<std::vector<std::vector<double>>> values;  // per result, per metric
    for (const Row& row : rows) {
        std::size_t r = 0;
        while (r < results.size() &&
               !(results[r].scene == row.key.scene && results[r].method == row.key.method &&
                 results[r].variant == row.key.variant))
            ++r;
        if (r == results.size()) {
            results.push_back({row.key.scene, row.key.method, row.key.variant, {}});
            values.emplace_back();
        }
        auto& metrics = results[r].metrics;
        std::size_t m = 0;
        while (m < metrics.size() && metrics[m].metric != row.sample.metric) ++m;
        if (m == metrics.size()) {
            metrics.push_back({row.sample.metric, row.sample.unit, {}});
            values[r].emplace_back();
        }
        values[r][m].push_back(row.sample.value);
    }
    for (std::size_t r = 0; r < results.size(); ++r)
        for (std::size_t m = 0; m < results[r].metrics.size(); ++m)
            results[r].metrics[m].statistics = statistics(values[r][m]);
    return results;
}

nlohmann::json to_json(std::span<const ResultSummary> results) {
    nlohmann::json list = nlohmann::json::array();
    for (const ResultSummary& result : results) {
        nlohmann::json metrics = nlohmann::json::object();
        for (const auto& [metric, unit, s] : result.metrics)
            metrics[metric] = {{"median", s.median}, {"min", s.min},
                               {"max", s.max},       {"mean", s.mean},
                               {"stddev", s.stddev}, {"n", s.n},
                               {"unit", unit},       {"ci95", {s.ci_low, s.ci_high}}};
        list.push_back({{"scene", result.scene},
                        {"method", result.method},
                        {"variant", result.variant},
                        {"metrics", std::move(metrics)}});
    }
    return {{"schema", 1}, {"results", std::move(list)}};
}

std::vector<ResultSummary> from_json(const nlohmann::json& json, const std::string& file) {
    try {
        if (json.at("schema") != 1)
            throw std::runtime_error(file +
                                     ": has another schema than 1; use the grove that wrote it");
        std::vector<ResultSummary> results;
        for (const auto& entry : json.at("results")) {
            ResultSummary result{entry.at("scene"), entry.at("method"), entry.at("variant"), {}};
            for (const auto& [name, m] : entry.at("metrics").items()) {
                Statistics s;
                s.n = m.at("n");
                s.median = number(m.at("median"));
                s.min = number(m.at("min"));
                s.max = number(m.at("max"));
                s.mean = number(m.at("mean"));
                s.stddev = number(m.at("stddev"));
                s.ci_low = number(m.at("ci95").at(0));
                s.ci_high = number(m.at("ci95").at(1));
                result.metrics.push_back({name, m.at("unit"), s});
            }
            results.push_back(std::move(result));
        }
        return results;
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error(file + ": is no summary of a run: " + error.what());
    }
}

std::string readable(double value, const std::string& unit) {
    if (!std::isfinite(value)) return fmt::format("{}", value);
    if (unit == "bytes") {
        static constexpr const char* kUnits[] = {"B", "kB", "MB", "GB"};
        int scale = 0;
        for (; std::abs(value) >= 1000 && scale < 3; ++scale) value /= 1000;
        return fmt::format("{} {}", scale == 0 ? with_separators(value) : four_digits(value),
                           kUnits[scale]);
    }
    if (unit == "1")
        return value == std::floor(value) ? with_separators(value) : four_digits(value);
    return four_digits(value) + " " + unit;
}

}  // namespace experiments::measure
