#include "shadows/bvh/query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "structures/parameters.hpp"

std::span<const taskpool::gpu::Shader> shadows_bvh_shaders();

namespace shadows::bvh {
namespace {

using structures::geometry::Light;
using taskpool::gpu::Buffer;
using taskpool::gpu::Kernel;

struct QueryPush {
    std::uint64_t points, visible, deferred, tiles, costs, status, header, nodes, triangles,
        scratch;
    glm::vec3 light;
    std::uint32_t point_count;
};

/// Workgroups of a query over `tiles` tiles. Where loops are cut, an invocation gets few tiles.
struct Launch {
    std::uint32_t groups, tiles_per_group;
};
Launch launch(const taskpool::gpu::DeviceInfo& info, std::uint32_t tiles) {
    if (info.loop_limit > 0) return {tiles, 1};
    return {std::min(info.persistent_workgroups, tiles), 0xffffffffu};
}

const char* shader_of(QueryKind kind) {
    switch (kind) {
        case QueryKind::lane:
            return "shadows/bvh/lane.comp";
        case QueryKind::packet:
            return "shadows/bvh/packet.comp";
        default:
            return "shadows/bvh/beam.comp";
    }
}

}  // namespace

Query::Query(taskpool::gpu::Device& device, const QueryConfig& config)
    : device_(device), config_(config) {
    using structures::SettingError;
    if (config.leaf != Leaf::exact && config.kind == QueryKind::beam)
        throw SettingError("leaf",
                           "'leaf' other than exact needs query = \"packet\" or \"lane\": "
                           "beams decide most points without a leaf test");
    if (config.contraction && config.leaf != Leaf::watertight)
        throw SettingError("contraction", "'contraction' = true needs leaf = \"watertight\"");
    // Every lane may append a whole leaf before the list is looked at.
    config_.list = std::max(config_.list, 8 * device.subgroup_size());
    // A traversal that a driver would cut must end before, on its own account.
    if (const std::uint32_t limit = device.info().loop_limit; limit > 0) {
        config_.steps = std::min(config_.steps, limit / 2);
        config_.point_steps = std::min(config_.point_steps, limit / 2);
    }
}

void Query::prepare(std::uint32_t point_count) {
    const std::uint32_t tiles = point_count / kTilePoints;
    const Launch groups = launch(device_.info(), std::max(tiles, 1u));
    visible_ = Buffer(device_, point_count / 8, "visibility");
    deferred_ = Buffer(device_, point_count / 8, "deferred points");
    tiles_ = Buffer(device_, tiles * 4, "deferred tiles");
    costs_ = Buffer(device_, config_.statistics ? point_count * sizeof(PointCost) : 0, "costs");
    status_ = Buffer(device_, sizeof(QueryStatus), "query status");
    scratch_ = Buffer(device_, std::size_t(groups.groups) * config_.list * 4, "query scratch");
    point_count_ = point_count;
}

std::size_t Query::memory_bytes() const {
    return visible_.size() + deferred_.size() + tiles_.size() + costs_.size() + status_.size() +
           scratch_.size();
}

Kernel Query::kernel(bool directional, bool deferred) const {
    const bool per_point = deferred || config_.kind == QueryKind::lane;
    const char* shader = deferred ? "shadows/bvh/deferred.comp" : shader_of(config_.kind);
    const std::uint32_t tiles = launch(device_.info(), 1u).tiles_per_group;
    return Kernel(device_, taskpool::gpu::find_shader(shadows_bvh_shaders(), shader),
                  {{1, directional},
                   {2, config_.statistics},
                   {3, per_point ? config_.point_stack : config_.stack},
                   {4, per_point ? config_.point_steps : config_.steps},
                   {5, tiles},
                   {6, device_.info().loop_limit > 0},
                   {7, config_.list},
                   {8, config_.density},
                   {9, kTilePoints / device_.subgroup_size()},
                   {20, static_cast<std::uint32_t>(config_.leaf)},
                   {21, config_.contraction},
                   {22, config_.bias}});
}

const Query::Kernels& Query::kernels(bool directional) {
    Kernels& found = kernels_[directional];
    if (!found.query.handle()) {
        found.query = kernel(directional, false);
        found.deferred = kernel(directional, true);
    }
    return found;
}

void Query::record(taskpool::gpu::Recorder& recorder, const structures::bvh::wide::WideTree& tree,
                   std::uint64_t points, std::uint32_t point_count, const Light& light) {
    if (point_count > point_count_)
        throw std::invalid_argument(
            fmt::format("Query::record: {} points, prepared for {}", point_count, point_count_));
    const bool directional = light.type == Light::Type::directional;
    const Kernels& pair = kernels(directional);
    const QueryPush push{points,
                         visible_.address(),
                         deferred_.address(),
                         tiles_.address(),
                         costs_.address(),
                         status_.address(),
                         tree.header,
                         tree.nodes,
                         tree.triangles,
                         scratch_.address(),
                         directional ? -light.vector : light.vector,
                         point_count};
    recorder.fill(status_, 0);
    recorder.barrier();
    // The counter of deferred tiles is the x of an indirect dispatch (x, slots, 1).
    recorder.fill(status_, kTilePoints / device_.subgroup_size(), kDeferredOffset + 4, 4);
    recorder.fill(status_, 1, kDeferredOffset + 8, 4);
    recorder.barrier();
    const std::uint32_t tiles = point_count / kTilePoints;
    recorder.dispatch(pair.query, push, launch(device_.info(), tiles).groups);
    recorder.barrier();
    recorder.dispatch_indirect(pair.deferred, push, status_, kDeferredOffset);
    recorder.barrier();
}

Visibility Query::visibility() const {
    return {taskpool::gpu::read<std::uint32_t>(visible_, point_count_ / 32)};
}

QueryStatus Query::status() const { return taskpool::gpu::read<QueryStatus>(status_, 1).front(); }

std::vector<PointCost> Query::costs() const {
    if (!config_.statistics) return {};
    return taskpool::gpu::read<PointCost>(costs_, point_count_);
}

}  // namespace shadows::bvh
