// Shadow query over a wide BVH.
//
//     Query query(device, {.kind = QueryKind::beam});
//     query.prepare(points.count());
//     query.record(recorder, wide_builder.tree(), points.address(), points.count(), light);
//
// and on as in shadows/tiles/tile_query.hpp. All kinds end in the same exact test per point
// (shadows/occlusion.glsl) and give the same bits:
//   lane    one segment per lane
//   packet  a subgroup's segments share one stack
//   beam    a subgroup owns a tile of 16 x 16 points and walks the tree with the tile's frustum
// Points of beams that meet too many triangles, or fill their stack or take too long, go on in
// packets, in the same kernel.
#pragma once

#include "shadows/bvh/leaf_shared.h"
#include "shadows/tiles/tile_query.hpp"
#include "structures/bvh/wide/wide.hpp"

namespace shadows::bvh {

enum class QueryKind { lane, packet, beam };
/// The leaf test: the exact one, or a shortcut, for measuring what it costs (leaf_variants.glsl).
enum class Leaf : std::uint32_t {
    exact = kLeafExact,
    watertight = kLeafWatertight,
    moeller_trumbore = kLeafMoellerTrumbore,
    double_precision = kLeafDouble
};

struct QueryConfig {
    QueryKind kind = QueryKind::beam;
    /// Small ones leave points of packets and beams to the per-point walk; a small `density` leaves
    /// them to packets. `scratch` holds the triangles that a beam collects before it tests them.
    tiles::Limits limits{};
    Leaf leaf = Leaf::exact;   ///< others: not with beams, which decide most points without it
    bool contraction = false;  ///< watertight: edge functions contracted as a compiler may
    float bias = 0;  ///< moves points towards the light: fraction of the way (of the diagonal)

    bool exact() const { return leaf == Leaf::exact && bias == 0; }
    bool operator==(const QueryConfig&) const = default;
};

class Query : public tiles::TileQuery {
  public:
    /// Throws structures::SettingError if the leaf test does not go with the rest.
    Query(taskpool::gpu::Device& device, const QueryConfig& config);

    void record(taskpool::gpu::Recorder& recorder, const structures::bvh::wide::WideTree& tree,
                std::uint64_t points, std::uint32_t point_count,
                const structures::geometry::Light& light) {
        TileQuery::record(recorder, tree, points, point_count, light);
    }
};

}  // namespace shadows::bvh
