// What C++ and the kernels of queries that answer tile by tile share.
#ifndef SHADOWS_TILES_QUERY_SHARED_H
#define SHADOWS_TILES_QUERY_SHARED_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace shadows::tiles {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

// Counters of one query.
struct QueryStatus {
    uint stack_full;       // traversals given up because their stack was full
    uint step_limit;       // packets and single segments given up because of too many steps
    uint packet_tiles;     // tiles some of whose points went on in packets
    uint deferred_points;  // points left to the per-point walk: as above, or undecided in fp64
    uint incomplete;       // points that even the per-point walk did not finish: must be 0
    uint exact_tests;      // with statistics: point-triangle pairs that beams left to the exact test
    uint groups;           // with statistics: groups of points that walked the tree
    // Tiles with deferred points: a list, walked by an indirect dispatch.
    uint deferred_groups_x;
    uint deferred_groups_y;
    uint deferred_groups_z;
    uint next_tile;
    uint fp64_decisions;   // with statistics: point-triangle pairs that went to double precision,
    uint exact_decisions;  // and of these, to error-free sums
};
GROVE_CONSTANT uint kDeferredOffset = 28u;

// With statistics, per point.
struct PointCost {
    uint nodes;
    uint triangles;
};

#ifdef __cplusplus
static_assert(sizeof(QueryStatus) == 52);
static_assert(offsetof(QueryStatus, deferred_groups_x) == kDeferredOffset);
static_assert(sizeof(PointCost) == 8);
}  // namespace shadows::tiles
#endif
#undef GROVE_CONSTANT
#endif
