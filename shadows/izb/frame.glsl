// The frame of the irregular z-buffer, and what its kernels share.
//
// Positions are taken relative to `origin`: the light, or for a directional light the middle of the
// mesh; scaled by a power of two to the order of 1; and with their axes permuted and mirrored so
// that z is the axis of a face of the cube around the light, or, for a directional light, the axis
// along which its direction is longest, growing towards the light. Then
//   point light        u = x / z,             v = y / z,             k = 1 / z
//   directional light  u = x - z t.x / t.z,   v = y - z t.y / t.z,   k = z
// A segment to the light keeps its u and v, and what occludes a point has the larger k.
#ifndef SHADOWS_IZB_FRAME_GLSL
#define SHADOWS_IZB_FRAME_GLSL
#include "taskpool/gpu/device.glsl"

#include "taskpool/gpu/shared_types.h"
layout(local_size_x_id = 0) in;

layout(constant_id = 1) const bool kDirectional = false;
layout(constant_id = 2) const bool kStatistics = false;
layout(constant_id = 3) const uint kChunksPerGroup = 0xffffffffu;
layout(constant_id = 4) const uint kBatchLimit = 0xffffffffu;  // batches of points per invocation
layout(constant_id = 5) const uint kChunkEntries = 64;         // at most one per lane

#include "shadows/beam/points.glsl"
#include "shadows/beam/edges.glsl"
#include "shadows/izb/izb_shared.h"
#include "shadows/occlusion.glsl"
#include "structures/geometry/corner_triangles.glsl"
#include "taskpool/primitives/ordered.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FrameRef { IzbFrame at; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExtentsRef { IzbExtents at; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Binned { IzbPoint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Entries { IzbEntry at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Ranges { IzbRange at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Status { IzbStatus at; };

layout(push_constant, scalar) uniform Push {
    FrameRef frame;
    FloatArray points;   // planes x, y, z, primitive of point_count words each
    UintArray cells;     // points per cell; then the first of each cell, and the end of the last
    UintArray farthest;  // pyramid: smallest k of a node's points, as an ordered word
    UintArray keys;      // cell of each point, or kNoCell; then pairs of an entry and a place of a
                         // point that double precision cannot tell
    UintArray places;    // its rank within the cell; then its place in the order of cells
    UintArray order;     // the point at each place
    Binned binned;       // in the order of cells
    CornerTriangles triangles;
    Entries entries;
    Ranges ranges;
    Status status;
    vec3 light;  // position, or direction towards the light
    uint point_count;
    uvec4 job;  // of the kernel; see there
}
push;

const uint kNoCell = 0xffffffffu;
const uint kNobody = 0xffffffffu;  // farthest: no point, or none that is not known to be shadowed
const float kLargestKey = 1e30;  // point light: points that are nearer still get this k

// From the world's axes to a face's.
vec3 to_face(vec3 v, uint face) {
    const vec3 permuted = axis_last(v, int(face >> 1));
    return vec3(permuted.xy, (face & 1u) != 0 ? -permuted.z : permuted.z);
}

const uint kNowhere = kFaces + 1u;

struct Projected {
    uint face;  // kFaces: the point cannot be shadowed, it is the light; kNowhere: it overflows
    float u, v, k;
    float reach;  // 1-norm in the frame
};

Projected project(vec3 p, vec3 origin, float scale, vec2 tilt, uint only_face) {
    Projected result;
    if (kDirectional) {
        const vec3 q = to_face((p - origin) * scale, only_face);
        result.u = q.x - q.z * tilt.x;
        result.v = q.y - q.z * tilt.y;
        result.k = q.z;
        result.reach = norm1(q);
        result.face = result.reach < 0.25 * kHuge ? only_face : kNowhere;  // u and v are finite
        return result;
    }
    const vec3 d = p - origin, size = abs(d);
    const uint axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const float low = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
    const uint face = 2 * axis + (low < 0 ? 1 : 0);
    const vec3 q = to_face(d, face);
    result.u = q.x / q.z;
    result.v = q.y / q.z;
    result.k = min(1.0 / (q.z * scale), kLargestKey);
    const float distance = norm1(q);
    result.reach = distance * scale;
    // NaN is nowhere, too.
    result.face = p == origin ? kFaces : distance > 0 && distance < kHuge ? face : kNowhere;
    return result;
}

vec3 position_of(uint point) {
    return vec3(push.points.at[point], push.points.at[push.point_count + point],
                push.points.at[2 * push.point_count + point]);
}
uint primitive_of(uint point) {
    return floatBitsToUint(push.points.at[3 * push.point_count + point]);
}

// From the point at a place in the order of cells to the light.
Segment segment_of(uint place) {
    const vec3 p = position_of(push.order.at[place]);
    if (kDirectional) return directional_segment(p, push.light);
    return point_segment(p, push.light);
}

// Index of this workgroup in a dispatch of one or two dimensions; there may be surplus ones.
uint workgroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// The run of points of this workgroup: job.x each.
uint run_begin() { return min(workgroup() * push.job.x, push.point_count); }
uint run_end() { return min(run_begin() + push.job.x, push.point_count); }

#endif
