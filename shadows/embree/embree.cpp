#include "shadows/embree/embree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace shadows::embree {
namespace {

using structures::Samples;
using structures::geometry::Light;

constexpr std::uint32_t kProbePoints = 1 << 16;
constexpr int kProbeRounds = 3;
/// Embree ends the program at rays with a coordinate above 1.8e18; differences of two of these stay
/// below that.
constexpr float kLargestCoordinate = 9e17f;

Trace trace_of(std::uint32_t width) {
    switch (width) {
        case 0:
            return nullptr;
        case 1:
            return trace_single;
        case 8:
            return trace_packets_8;
        case 16:
            return trace_packets_16;
        case 64:
            return trace_streams;
        default:
            throw std::invalid_argument(fmt::format(
                "embree: width is {}; give 1, 8, 16, 64, or 0 for the faster packets", width));
    }
}

/// Embree ends the program at rays that begin or end out of its range.
void check_range(const structures::geometry::Aabb& box) {
    const glm::vec3 limit(kLargestCoordinate);
    if (glm::all(glm::greaterThanEqual(box.lower, -limit)) &&
        glm::all(glm::lessThanEqual(box.upper, limit)))
        return;
    throw std::invalid_argument(fmt::format(
        "embree: a coordinate of the light, the mesh or a point exceeds {:g}, beyond which Embree "
        "traces no ray; move it nearer, or make the light directional",
        kLargestCoordinate));
}

}  // namespace

EmbreeMethod::EmbreeMethod(const Config& config)
    : config_(config),
      scene_(config.threads),
      workers_(config.threads),
      trace_(trace_of(config.width)) {
    if (config.chunk == 0 || config.chunk % kTilePoints != 0)
        throw std::invalid_argument(
            fmt::format("embree: chunk is {}; give a multiple of {}", config.chunk, kTilePoints));
}

void EmbreeMethod::prepare(const structures::geometry::TriangleMesh& mesh) {
    scene_.load(mesh);
    bounds_ = mesh.bounds();
    rays_.reset();
    trace_ = trace_of(config_.width);  // width 0 decides anew for another scene
}

Samples EmbreeMethod::build(const Light& light) {
    if (!bounds_.empty()) check_range(bounds_);
    if (light.type == Light::Type::point) check_range({light.vector, light.vector});
    const double build_ms = scene_.build(config_.quality);
    rays_ = std::make_unique<ShadowRays>(light, glm::length(bounds_.extent()), config_.bias);
    return {{"build_ms", build_ms, "ms"},
            {"memory_bytes", static_cast<double>(scene_.memory_bytes()), "bytes"}};
}

double EmbreeMethod::trace_all(Trace trace, const PointArrays& points, std::uint32_t stride,
                               std::vector<std::uint32_t>& words) {
    const auto count = static_cast<std::uint32_t>(points.x.size());
    const std::uint32_t chunks = (count + config_.chunk - 1) / config_.chunk;
    const auto begin = std::chrono::steady_clock::now();
    workers_.run((chunks + stride - 1) / stride, [&](std::uint32_t i) {
        const std::uint32_t first = i * stride * config_.chunk;
        trace(scene_.handle(), *rays_, points, first, std::min(config_.chunk, count - first),
              words);
    });
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

Trace EmbreeMethod::faster_packets(const PointArrays& points) {
    std::vector<std::uint32_t> words(points.x.size() / 32);
    const auto stride = std::max(1u, static_cast<std::uint32_t>(points.x.size()) / kProbePoints);
    double best_8 = INFINITY, best_16 = INFINITY;
    for (int round = 0; round < kProbeRounds; ++round) {
        best_8 = std::min(best_8, trace_all(trace_packets_8, points, stride, words));
        best_16 = std::min(best_16, trace_all(trace_packets_16, points, stride, words));
    }
    return best_16 < best_8 ? trace_packets_16 : trace_packets_8;
}

Samples EmbreeMethod::query(const Points& points, Visibility& visible) {
    if (!scene_.handle() || !rays_) throw std::logic_error("embree: query() before build()");
    const PointArrays& host = points.host();
    structures::geometry::Aabb reach;
    for (std::uint32_t i = 0; i < points.count(); ++i)
        reach.grow({host.x[i], host.y[i], host.z[i]});
    if (points.count() > 0) check_range(reach);
    if (!trace_) trace_ = faster_packets(points.host());
    visible.words.resize(points.count() / 32);
    const double query_ms = trace_all(trace_, points.host(), 1, visible.words);
    const double rays = points.valid_count();
    return {{"query_ms", query_ms, "ms"},
            {"rays", rays},
            {"mrays_per_s", query_ms > 0 ? rays / query_ms * 1e-3 : 0, "Mrays/s"}};
}

}  // namespace shadows::embree
