// What the kernels of the BVH shadow query share: parameters, tiles, points, answers.
#include "taskpool/gpu/device.glsl"
#include "structures/bvh/wide/wide_node.glsl"
#include "shadows/beam/points.glsl"
#include "shadows/occlusion.glsl"
#include "shadows/bvh/query_shared.h"
layout(local_size_x_id = 0) in;

layout(constant_id = 1) const bool kDirectional = false;
layout(constant_id = 2) const bool kStatistics = false;
layout(constant_id = 3) const uint kStackLimit = 64u;     // entries
layout(constant_id = 4) const uint kStepLimit = 1000000u; // loop iterations of one traversal, or,
layout(constant_id = 6) const bool kLoopsAreCut = false;  // with this, of the whole invocation
layout(constant_id = 5) const uint kTilesPerGroup = 0xffffffffu;
layout(constant_id = 22) const float kBias = 0.0;  // how far points move towards the light: a
                                                   // fraction of the way, or of the scene's diagonal

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
    WideHeaderRef header;
    WideChildren nodes;
    WideTriangles triangles;
    LaneWords scratch;      // of each workgroup
    vec3 light;             // position, or direction towards the light
    uint point_count;
} push;

const uint kNoTile = 0xffffffffu;

vec3 position_of(uint point) {
    const vec3 p = vec3(push.points.at[point], push.points.at[push.point_count + point],
                        push.points.at[2 * push.point_count + point]);
    if (kBias == 0.0) return p;
    if (!kDirectional) return p + kBias * (push.light - p);
    const WideHeader header = push.header.header;
    return p + kBias * length(header.upper - header.origin) * normalize(push.light);
}
uint primitive_of(uint point) {
    return floatBitsToUint(push.points.at[3 * push.point_count + point]);
}

Segment segment_of(uint point) {
    if (kDirectional) return directional_segment(position_of(point), push.light);
    return point_segment(position_of(point), push.light);
}

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
