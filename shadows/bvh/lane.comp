// Shadow query, one segment per lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/any_hit.glsl"

void main() {
    BvhView view = BvhView(push.header, push.nodes, push.triangles);
    uint taken = 0, stack_full = 0, step_limit = 0, steps = kStepLimit;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        uint occluded = 0, deferred = 0;
        for (uint k = 0; k < kSlots; ++k) {
            const uint point = tile_point(tile, k);
            const uint primitive = primitive_of(point);
            BvhWalk walk = bvh_walk_begin(steps);
            if (primitive != kNoPrimitive) {
                if (bvh_occluded(view, segment_of(point), primitive, false, walk)) occluded |= 1u << k;
                if (walk.end != kEndFinished) deferred |= 1u << k;
                stack_full += walk.end == kEndStackFull ? 1 : 0;
                step_limit += walk.end == kEndStepLimit ? 1 : 0;
            }
            steps = steps_after(walk.steps);
            if (kStatistics) push.costs.at[point] = PointCost(walk.nodes, walk.triangles);
        }
        store_tile(push.visible, tile, ~occluded);
        defer(tile, deferred);
    }
    count_decisions();
    if (stack_full > 0) atomicAdd(push.status.at.stack_full, stack_full);
    if (step_limit > 0) atomicAdd(push.status.at.step_limit, step_limit);
}
