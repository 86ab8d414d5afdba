// Shadow query over a wide BVH: for each G-buffer point, is the segment to the light free?
//
//     Query query(device, {.kind = QueryKind::beam});
//     query.prepare(points.count());
//     query.record(recorder, wide_builder.tree(), points.address(), points.count(), light);
//     device.run(recorder);
//     Visibility visible = query.visibility();
//     assert(query.status().incomplete == 0);
//
// All kinds end in the same exact test per point (shadows/occlusion.glsl) and give the same bits:
//   lane    one segment per lane
//   packet  a subgroup's segments share one stack
//   beam    a subgroup owns a tile of 16 x 16 points and walks the tree with the tile's frustum
// Points of beams that meet too many triangles, or fill their stack or take too long, go on in
// packets, in the same kernel. What packets cannot finish within their limits, or without the last
// resort of the exact test (occludes_exactly), is left to a per-point walk, recorded behind them as
// an indirect dispatch; nothing is dropped, and the status counts what happened.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shadows/bvh/query_shared.h"
#include "shadows/points.hpp"
#include "structures/bvh/wide/wide.hpp"
#include "structures/geometry/light.hpp"
#include "taskpool/gpu/recorder.hpp"

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
    bool statistics = false;
    // Limits of packet and beam. Small ones leave points to the per-point walk; a small `density`
    // leaves them to packets.
    std::uint32_t stack = 32;         ///< entries of the traversal stack
    std::uint32_t list = 1024;        ///< triangles collected before they are processed
    std::uint32_t steps = 1'000'000;  ///< loop iterations of one traversal
    std::uint32_t density = 3;        ///< triangles per point that a beam may meet
    // Limits of the per-point walk.
    std::uint32_t point_stack = 32;
    std::uint32_t point_steps = 10'000'000;
    Leaf leaf = Leaf::exact;   ///< others: not with beams, which decide most points without it
    bool contraction = false;  ///< watertight: edge functions contracted as a compiler may
    float bias = 0;  ///< moves points towards the light: fraction of the way (of the diagonal)

    bool exact() const { return leaf == Leaf::exact && bias == 0; }
    bool operator==(const QueryConfig&) const = default;
};

class Query {
  public:
    /// Throws structures::SettingError if the leaf test does not go with the rest.
    Query(taskpool::gpu::Device& device, const QueryConfig& config);

    /// Allocates for up to `point_count` points.
    void prepare(std::uint32_t point_count);
    std::size_t memory_bytes() const;

    /// Records one query: `points` is the address of four planes of `point_count` words (Points).
    /// Submits nothing. Throws std::invalid_argument if more points were not prepared for.
    void record(taskpool::gpu::Recorder& recorder, const structures::bvh::wide::WideTree& tree,
                std::uint64_t points, std::uint32_t point_count,
                const structures::geometry::Light& light);

    /// Of the last finished query.
    Visibility visibility() const;
    QueryStatus status() const;
    /// With statistics: per point, nodes visited and triangles tested by the traversals it took
    /// part in.
    std::vector<PointCost> costs() const;

  private:
    struct Kernels {
        taskpool::gpu::Kernel query, deferred;
    };
    const Kernels& kernels(bool directional);
    taskpool::gpu::Kernel kernel(bool directional, bool deferred) const;

    taskpool::gpu::Device& device_;
    QueryConfig config_;
    std::array<Kernels, 2> kernels_;  ///< point, directional; compiled when first needed
    taskpool::gpu::Buffer visible_, deferred_, tiles_, costs_, status_, scratch_;
    std::uint32_t point_count_ = 0;
};

}  // namespace shadows::bvh
