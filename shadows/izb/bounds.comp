// Extent of the points of each face. Workgroup i takes job.x points from i job.x on; the words go
// to the extents at address job.zw.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const IzbFrame frame = push.frame.at;
    vec2 lower[kFaces], upper[kFaces];
    float reach[kFaces];
    uint points[kFaces], unplaced = 0;
    [[unroll]] for (uint f = 0; f < kFaces; ++f) {
        lower[f] = vec2(kHuge);
        upper[f] = vec2(-kHuge);
        reach[f] = 0;
        points[f] = 0;
    }
    for (uint first = run_begin(); first < run_end(); first += gl_SubgroupSize) {
        const uint point = first + lane();
        const Projected q =
            project(position_of(point), frame.origin, frame.scale, frame.tilt, frame.face);
        const bool asked = primitive_of(point) != kNoPrimitive;
        unplaced += asked && q.face == kNowhere ? 1 : 0;
        [[unroll]] for (uint f = 0; f < kFaces; ++f) {
            const bool here = asked && q.face == f;
            const vec2 uv = vec2(q.u, q.v);
            lower[f] = min(lower[f], here ? uv : vec2(kHuge));
            upper[f] = max(upper[f], here ? uv : vec2(-kHuge));
            reach[f] = max(reach[f], here ? q.reach : 0.0);
            points[f] += here ? 1 : 0;
        }
    }
    ExtentsRef extents = ExtentsRef(packUint2x32(push.job.zw));
    unplaced = subgroupAdd(unplaced);
    if (unplaced > 0 && lane() == 0) atomicAdd(extents.at.unplaced, unplaced);
    [[unroll]] for (uint f = 0; f < kFaces; ++f) {
        const vec2 least = reduce_min(lower[f]), most = reduce_max(upper[f]);
        const float farthest = reduce_max(reach[f]);
        const uint count = subgroupAdd(points[f]);
        if (count > 0 && lane() == 0) {
            atomicMax(extents.at.faces[f].not_lower_u, ~ordered(least.x));
            atomicMax(extents.at.faces[f].not_lower_v, ~ordered(least.y));
            atomicMax(extents.at.faces[f].upper_u, ordered(most.x));
            atomicMax(extents.at.faces[f].upper_v, ordered(most.y));
            atomicMax(extents.at.faces[f].reach, ordered(farthest));
            atomicAdd(extents.at.faces[f].points, count);
        }
    }
}
