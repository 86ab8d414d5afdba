#include "shadows/tiles/tile_query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace shadows::tiles {
namespace {

using structures::geometry::Light;
using taskpool::gpu::Buffer;
using taskpool::gpu::Kernel;

/// Workgroups of a query over `tiles` tiles. Where loops are cut, an invocation gets few tiles.
struct Launch {
    std::uint32_t groups, tiles_per_group;
};
Launch launch(const taskpool::gpu::DeviceInfo& info, std::uint32_t tiles) {
    if (info.loop_limit > 0) return {tiles, 1};
    return {std::min(info.persistent_workgroups, tiles), 0xffffffffu};
}

}  // namespace

TileQuery::TileQuery(taskpool::gpu::Device& device, const Limits& limits, Shaders shaders)
    : device_(device), limits_(limits), shaders_(std::move(shaders)) {
    // A traversal that a driver would cut must end before, on its own account.
    if (const std::uint32_t limit = device.info().loop_limit; limit > 0) {
        limits_.steps = std::min(limits_.steps, limit / 2);
        limits_.point_steps = std::min(limits_.point_steps, limit / 2);
    }
}

void TileQuery::prepare(std::uint32_t point_count) {
    const std::uint32_t tiles = point_count / kTilePoints;
    const std::size_t scratch_words =
        std::size_t(launch(device_.info(), std::max(tiles, 1u)).groups) * limits_.scratch;
    visible_ = Buffer(device_, point_count / 8, "visibility");
    deferred_ = Buffer(device_, point_count / 8, "deferred points");
    tiles_ = Buffer(device_, tiles * 4, "deferred tiles");
    costs_ = Buffer(device_, limits_.statistics ? point_count * sizeof(PointCost) : 0, "costs");
    status_ = Buffer(device_, sizeof(QueryStatus), "query status");
    scratch_ = Buffer(device_, scratch_words * 4, "query scratch");
    point_count_ = point_count;
}

std::size_t TileQuery::memory_bytes() const {
    return visible_.size() + deferred_.size() + tiles_.size() + costs_.size() + status_.size() +
           scratch_.size();
}

Kernel TileQuery::kernel(bool directional, bool deferred) const {
    const bool per_point = deferred || shaders_.per_point;
    std::vector<taskpool::gpu::Constant> constants{
        {1, directional},
        {2, limits_.statistics},
        {3, per_point ? limits_.point_stack : limits_.stack},
        {4, per_point ? limits_.point_steps : limits_.steps},
        {5, launch(device_.info(), 1u).tiles_per_group},
        {6, device_.info().loop_limit > 0},
        {7, limits_.scratch},
        {8, limits_.density},
        {9, kTilePoints / device_.subgroup_size()}};
    constants.insert(constants.end(), shaders_.constants.begin(), shaders_.constants.end());
    return Kernel(device_, deferred ? *shaders_.deferred : *shaders_.query, constants);
}

const TileQuery::Kernels& TileQuery::kernels(bool directional) {
    Kernels& found = kernels_[directional];
    if (!found.query.handle()) {
        found.query = kernel(directional, false);
        found.deferred = kernel(directional, true);
    }
    return found;
}

TileQuery::CommonPush TileQuery::push_for(std::uint64_t points, std::uint32_t point_count,
                                          const Light& light) const {
    if (point_count > point_count_)
        throw std::invalid_argument(
            fmt::format("shadow query: {} points, prepared for {}", point_count, point_count_));
    return {points,
            visible_.address(),
            deferred_.address(),
            tiles_.address(),
            costs_.address(),
            status_.address(),
            scratch_.address(),
            light.type == Light::Type::directional ? -light.vector : light.vector,
            point_count};
}

void TileQuery::record_clearing(taskpool::gpu::Recorder& recorder) const {
    recorder.fill(status_, 0);
    recorder.barrier();
    // The counter of deferred tiles is the x of an indirect dispatch (x, slots, 1).
    recorder.fill(status_, kTilePoints / device_.subgroup_size(), kDeferredOffset + 4, 4);
    recorder.fill(status_, 1, kDeferredOffset + 8, 4);
    recorder.barrier();
}

std::uint32_t TileQuery::groups(std::uint32_t point_count) const {
    return launch(device_.info(), point_count / kTilePoints).groups;
}

Visibility TileQuery::visibility() const {
    return {taskpool::gpu::read<std::uint32_t>(visible_, point_count_ / 32)};
}

QueryStatus TileQuery::status() const {
    return taskpool::gpu::read<QueryStatus>(status_, 1).front();
}

std::vector<PointCost> TileQuery::costs() const {
    if (!limits_.statistics) return {};
    return taskpool::gpu::read<PointCost>(costs_, point_count_);
}

structures::Samples TileQuery::counters(std::uint32_t valid_count) const {
    const QueryStatus counted = status();
    structures::Samples samples{{"incomplete", double(counted.incomplete)},
                                {"deferred_points", double(counted.deferred_points)}};
    if (!limits_.statistics) return samples;
    double nodes = 0, triangles = 0;
    std::uint32_t most = 0;
    for (const PointCost& cost : costs()) {
        nodes += cost.nodes;
        triangles += cost.triangles;
        most = std::max(most, cost.nodes);
    }
    const double count = std::max(valid_count, 1u);
    samples.push_back({"visited_nodes_mean", nodes / count});
    samples.push_back({"visited_nodes_max", double(most)});
    samples.push_back({"tested_triangles_mean", triangles / count});
    samples.push_back({"exact_tests_mean", counted.exact_tests / count});
    samples.push_back({"fp64_decisions", double(counted.fp64_decisions)});
    samples.push_back({"exact_decisions", double(counted.exact_decisions)});
    samples.push_back({"groups", double(counted.groups)});
    samples.push_back({"packet_tiles", double(counted.packet_tiles)});
    return samples;
}

std::vector<float> TileQuery::heat() const {
    std::vector<float> nodes;
    for (const PointCost& cost : costs()) nodes.push_back(float(cost.nodes));
    return nodes;
}

}  // namespace shadows::tiles
