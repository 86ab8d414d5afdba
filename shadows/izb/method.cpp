#include "shadows/izb/method.hpp"

#include <algorithm>

namespace shadows::izb {
namespace {

using structures::Parameter;
using structures::Samples;
using structures::Settings;

std::span<const Parameter> parameters() {
    static const Parameter all[] = {
        {"resolution",
         std::int64_t{0},
         "cells along a face's longer side, rounded up to a power of two; 0: from the points",
         {},
         0,
         kMaxResolution},
        {"statistics", false, "count tests of points against triangles (slower)"},
    };
    return all;
}

QueryConfig query_config(const Settings& settings) {
    QueryConfig config;
    config.resolution = static_cast<std::uint32_t>(settings.integer("resolution"));
    config.statistics = settings.boolean("statistics");
    return config;
}

std::unique_ptr<Method> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<IzbMethod>(device, settings);
}

}  // namespace

IzbMethod::IzbMethod(taskpool::gpu::Device& device, const Settings& settings)
    : config_(query_config(settings)), query_(device, config_) {}

void IzbMethod::prepare(const structures::geometry::TriangleMesh& mesh) { query_.prepare(mesh); }

Samples IzbMethod::build(const structures::geometry::Light& light) {
    query_.set_light(light);
    return {{"build_ms", 0, "ms"}};
}

Samples IzbMethod::query(const Points& points, Visibility& visible) {
    const QueryResult result = query_.run(points, visible);
    Samples samples{{"query_ms", result.milliseconds, "ms"},
                    {"memory_bytes", double(query_.memory_bytes()), "bytes"},
                    {"incomplete", double(result.incomplete)},
                    {"cells", double(result.cells)},
                    {"entries", double(result.entries)},
                    {"ranges", double(result.ranges)},
                    {"passes", double(result.passes)}};
    if (config_.statistics) {
        const double count = std::max(points.valid_count(), 1u);
        samples.push_back({"tested_triangles_mean", double(result.tests) / count});
        samples.push_back({"exact_tests_mean", double(result.exact_tests) / count});
        samples.push_back({"exact_decisions", double(result.unsure)});
    }
    return samples;
}

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"izb", "irregular z-buffer: points binned as seen from the light, exact", &parameters,
         &create},
    };
    return all;
}

}  // namespace shadows::izb
