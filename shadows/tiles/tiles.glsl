// What queries that answer tile by tile share: parameters, tiles, points, answers.
//
//     #include "taskpool/gpu/device.glsl"
//     layout(constant_id = 1) const bool kDirectional = false;
//     struct Structure { ... };                  // addresses of what is walked, at most 56 bytes
//     #include "shadows/tiles/tiles.glsl"
//     vec3 asked_from(vec3 p) { return p; }      // hook: where the segment of point p begins
//
// then one of lanes.glsl, packets.glsl and beams.glsl, which say what a structure has to offer for them.
#ifndef SHADOWS_TILES_TILES_GLSL
#define SHADOWS_TILES_TILES_GLSL
#include "taskpool/gpu/shared_types.h"
#include "shadows/tiles/query_shared.h"
#include "shadows/beam/points.glsl"
layout(local_size_x_id = 0) in;

layout(constant_id = 2) const bool kStatistics = false;
layout(constant_id = 3) const uint kStackLimit = 64u;     // entries
layout(constant_id = 4) const uint kStepLimit = 1000000u; // loop iterations of one traversal, or,
layout(constant_id = 6) const bool kLoopsAreCut = false;  // with this, of the whole invocation
layout(constant_id = 5) const uint kTilesPerGroup = 0xffffffffu;
layout(constant_id = 7) const uint kScratchWords = 1024u;  // of a workgroup

#include "shadows/occlusion.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Status { QueryStatus at; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Costs { PointCost at[]; };

/// Words that lanes exchange: only nonprivate accesses take part in the memory model's barriers.
layout(buffer_reference, scalar, buffer_reference_align = 4) nonprivate buffer LaneWords {
    uint at[];
};

layout(push_constant, scalar) uniform Push {
    FloatArray points;      // planes x, y, z, primitive of point_count words each
    UintArray visible;      // one bit per point
    UintArray deferred;     // one bit per point: left to the per-point walk
    UintArray tiles;        // tiles with such points
    Costs costs;            // with statistics
    Status status;
    LaneWords scratch;      // kScratchWords of each workgroup
    vec3 light;             // position, or direction towards the light
    uint point_count;
    Structure structure;
} push;

vec3 asked_from(vec3 p);

const uint kNoTile = 0xffffffffu;

vec3 position_of(uint point) {
    return asked_from(vec3(push.points.at[point], push.points.at[push.point_count + point],
                           push.points.at[2 * push.point_count + point]));
}
uint primitive_of(uint point) {
    return floatBitsToUint(push.points.at[3 * push.point_count + point]);
}

Segment segment_from(vec3 p) {
    if (kDirectional) return directional_segment(p, push.light);
    return point_segment(p, push.light);
}
Segment segment_of(uint point) { return segment_from(position_of(point)); }

// The next tile of this workgroup, or kNoTile. Tiles are handed out by a counter, since their costs
// differ widely; `taken` counts them, so that drivers that cut long loops get short ones.
uint next_tile(inout uint taken) {
    if (taken >= kTilesPerGroup) return kNoTile;
    ++taken;
    uint tile = 0;
    if (lane() == 0) tile = atomicAdd(push.status.at.next_tile, 1u);
    tile = subgroupBroadcastFirst(tile);
    return tile < push.point_count / kTilePoints ? tile : kNoTile;
}

// ---- Walks ----------------------------------------------------------------------------------------

const uint kEndFinished = 0u, kEndStackFull = 1u, kEndStepLimit = 2u, kEndUnsure = 3u;

// What a walk has cost, what it may still cost, and why it ended: without a hit, only kEndFinished is
// an answer.
struct Walk {
    uint nodes;      // visited
    uint triangles;  // tested
    uint steps;      // loop iterations that are left
    uint end;
};
Walk walk_begin(uint step_limit) { return Walk(0, 0, step_limit, kEndFinished); }

// Steps that the next traversal may take, after one that left `steps`.
// A loop runs as long as one lane needs it: the lane with the fewest left decides.
uint steps_after(uint steps) { return kLoopsAreCut ? subgroupMin(steps) : kStepLimit; }

// Adds this invocation's decisions beyond single precision to the status.
void count_decisions() {
    if (!kStatistics || double_decisions == 0) return;
    atomicAdd(push.status.at.fp64_decisions, double_decisions);
    atomicAdd(push.status.at.exact_decisions, exact_decisions);
}

// Leaves a tile's `slots` to the per-point walk, if there are any.
void defer(uint tile, uint slots) {
    if (!subgroupAny(slots != 0)) return;
    store_tile(push.deferred, tile, slots);
    if (lane() == 0) push.tiles.at[atomicAdd(push.status.at.deferred_groups_x, 1u)] = tile;
    const uint count = subgroupAdd(bitCount(slots));
    if (lane() == 0) atomicAdd(push.status.at.deferred_points, count);
}

#endif
