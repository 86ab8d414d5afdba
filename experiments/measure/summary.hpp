// summary.json: statistics of every metric of every scene, method and variant.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "experiments/measure/samples_file.hpp"
#include "experiments/measure/statistics.hpp"

namespace experiments::measure {

struct MetricSummary {
    std::string metric, unit;
    Statistics statistics;
};

struct ResultSummary {
    std::string scene, method, variant;
    std::vector<MetricSummary> metrics;  ///< in the order they were first measured

    /// The metric of that name, or nullptr.
    const MetricSummary* find(std::string_view metric) const;
    /// The metric's median, 0 if it was not measured.
    double median(std::string_view metric) const;
    /// "bvh query=lane"; "bvh" for variant "default".
    std::string label() const;
};

/// Groups `rows` in order of first appearance; repetitions and frames are pooled.
std::vector<ResultSummary> summarise(std::span<const Row> rows);

/// `{"schema": 1, "results": [...]}`.
nlohmann::json to_json(std::span<const ResultSummary> results);
/// The inverse. Throws std::runtime_error naming `file` if `json` is no summary of schema 1.
std::vector<ResultSummary> from_json(const nlohmann::json& json, const std::string& file);

/// "12.3 ms", "1.5 MB", "1,234,567": `value` for a reader.
std::string readable(double value, const std::string& unit);

}  // namespace experiments::measure
