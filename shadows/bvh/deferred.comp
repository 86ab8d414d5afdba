// The last word on points that a query left over: one segment per lane and invocation, so that each
// has all of an invocation's steps. Workgroup (x, y) takes slot y of the x-th tile with such points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/any_hit.glsl"

void main() {
    const uint point = tile_point(push.tiles.at[gl_WorkGroupID.x], gl_WorkGroupID.y);
    const uint word = point / 32, bit = 1u << (point % 32);
    if ((push.deferred.at[word] & bit) == 0) return;
    BvhView view = BvhView(push.header, push.nodes, push.triangles);
    BvhWalk walk = bvh_walk_begin(kStepLimit);
    if (bvh_occluded(view, segment_of(point), primitive_of(point), true, walk))
        atomicAnd(push.visible.at[word], ~bit);
    else if (walk.end != kEndFinished)
        atomicAdd(push.status.at.incomplete, 1u);
    count_decisions();
    if (kStatistics) {
        push.costs.at[point].nodes += walk.nodes;
        push.costs.at[point].triangles += walk.triangles;
    }
}
