#include "shadows/bvh/query.hpp"

#include <algorithm>

#include "structures/parameters.hpp"

std::span<const taskpool::gpu::Shader> shadows_bvh_shaders();

namespace shadows::bvh {
namespace {

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

tiles::Shaders shaders(const QueryConfig& config) {
    using structures::SettingError;
    if (config.leaf != Leaf::exact && config.kind == QueryKind::beam)
        throw SettingError("leaf",
                           "'leaf' other than exact needs query = \"packet\" or \"lane\": "
                           "beams decide most points without a leaf test");
    if (config.contraction && config.leaf != Leaf::watertight)
        throw SettingError("contraction", "'contraction' = true needs leaf = \"watertight\"");
    const auto find = [](const char* name) {
        return &taskpool::gpu::find_shader(shadows_bvh_shaders(), name);
    };
    return {find(shader_of(config.kind)),
            find("shadows/bvh/deferred.comp"),
            config.kind == QueryKind::lane,
            {{20, static_cast<std::uint32_t>(config.leaf)},
             {21, config.contraction},
             {22, config.bias}}};
}

/// Every lane may append a whole leaf before a beam's list is looked at.
tiles::Limits limits(const taskpool::gpu::Device& device, tiles::Limits limits) {
    limits.scratch = std::max(limits.scratch, 8 * device.subgroup_size());
    return limits;
}

}  // namespace

Query::Query(taskpool::gpu::Device& device, const QueryConfig& config)
    : TileQuery(device, limits(device, config.limits), shaders(config)) {}

}  // namespace shadows::bvh
