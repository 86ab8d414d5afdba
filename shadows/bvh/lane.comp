// Shadow query, one segment per lane. As the pass for deferred points it has the last word on what
// the other kernels gave up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/any_hit.glsl"

void main() {
    BvhView view = BvhView(push.header, push.nodes, push.triangles);
    uint taken = 0, stack_full = 0, step_limit = 0, finished = 0;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        uint lit = 0;
        for (uint k = 0; k < kSlots; ++k) {
            const uint point = tile_point(tile, k);
            const uint primitive = primitive_of(point);
            bool asked = primitive != kNoPrimitive;
            if (kDeferred) {
                asked = (push.deferred.at[point / 32] >> (point % 32) & 1u) != 0;
                if ((push.visible.at[point / 32] >> (point % 32) & 1u) != 0) lit |= 1u << k;
            } else {
                lit |= 1u << k;
            }
            if (asked) {
                const vec3 p = position_of(point);
                Segment segment;
                if (kDirectional)
                    segment = directional_segment(p, push.light);
                else
                    segment = point_segment(p, push.light);
                BvhWalk walk = bvh_walk_begin();
                if (bvh_occluded(view, segment, primitive, walk)) lit &= ~(1u << k);
                stack_full += walk.end == kEndStackFull ? 1 : 0;
                step_limit += walk.end == kEndStepLimit ? 1 : 0;
                if (kStatistics) {
                    PointCost cost = PointCost(walk.nodes, walk.triangles);
                    if (kDeferred) {
                        cost.nodes += push.costs.at[point].nodes;
                        cost.triangles += push.costs.at[point].triangles;
                    }
                    push.costs.at[point] = cost;
                }
            }
        }
        store_tile(push.visible, tile, lit);
        ++finished;
    }
    count_status(stack_full, step_limit, stack_full + step_limit);
    if (lane() == 0 && !kDeferred) atomicAdd(push.status.at.finished_tiles, finished);
}
