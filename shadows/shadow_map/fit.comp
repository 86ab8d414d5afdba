// Rendering a shadow map, step 1: which triangles reach into which face, and what they span there.
//
// A triangle reaches a face unless its corners are all beyond one of the face's sides or all behind
// the light; the few that pass a corner of the face beside it are listed too. What it spans is
// bounded by its corners, cut to the face; if one is behind the light, by the whole face. The
// nearest w, which the precision of depths hangs on, is bounded by the triangle's distance from the
// light: within a face, w is at least 1 / sqrt(3) of that.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "shadows/shadow_map/view.glsl"
#include "taskpool/primitives/ordered.glsl"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Block { FitPush push; };

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FitRef { Fit at; };

const uint kViews = kDirectional ? 1 : kFaces;
const float kLargest = 3.402823466e38;

float distance_to_segment(vec3 a, vec3 b) {
    const vec3 edge = b - a;
    return length(a + clamp(-dot(a, edge) / max(dot(edge, edge), 1e-30), 0, 1) * edge);
}

// At most the w at which a face may see the triangle, whose corners are relative to the light.
float nearest(vec3 a, vec3 b, vec3 c) {
    const vec3 reach = max(max(abs(a), abs(b)), abs(c));
    const float size = max(max(reach.x, reach.y), reach.z);
    if (!(size > 0)) return 0;
    a /= size;
    b /= size;
    c /= size;
    float distance =
        min(min(distance_to_segment(a, b), distance_to_segment(b, c)), distance_to_segment(c, a));
    const vec3 normal = cross(b - a, c - a);
    const vec3 sides =
        vec3(dot(normal, cross(a, b)), dot(normal, cross(b, c)), dot(normal, cross(c, a)));
    if (all(greaterThanEqual(sides, vec3(-1e-6))) && dot(normal, normal) > 0)
        distance = min(distance, abs(dot(a, normalize(normal))));
    // 1 / sqrt(3) = 0.577; the rest is for rounding.
    return max(0.5 * distance - 1e-6, 0) * size;
}

bool reaches(vec3 a, vec3 b, vec3 c) {
    if (kDirectional) return true;
    const vec3 w = vec3(a.z, b.z, c.z), x = vec3(a.x, b.x, c.x), y = vec3(a.y, b.y, c.y);
    const vec3 side = w * push.reach;
    return !(all(lessThanEqual(w, vec3(0))) || all(greaterThan(x, side)) ||
             all(lessThan(x, -side)) || all(greaterThan(y, side)) || all(lessThan(y, -side)));
}

// Adds the triangle ids of those lanes that have one to the face's list.
void list_caster(uint face, bool has_one, uint triangle) {
    const uvec4 vote = subgroupBallot(has_one);
    const uint count = subgroupBallotBitCount(vote);
    if (count == 0) return;
    uint first = 0;
    if (subgroupElect()) first = atomicAdd(FitRef(push.fit).at.casters[face], count);
    first = subgroupBroadcastFirst(first);
    if (has_one)
        UintArray(push.casters)
            .at[face * push.triangle_count + first + subgroupBallotExclusiveBitCount(vote)] =
            triangle;
}

void main() {
    float bounds[kFaces * kBounds];
    [[unroll]] for (uint i = 0; i < kFaces * kBounds; ++i) bounds[i] = kLargest;
    const uint stride = gl_NumWorkGroups.x * gl_SubgroupSize;
    for (uint first = gl_WorkGroupID.x * gl_SubgroupSize; first < push.triangle_count;
         first += stride) {
        const uint triangle = min(first + gl_SubgroupInvocationID, push.triangle_count - 1);
        const bool own = triangle == first + gl_SubgroupInvocationID;
        const uvec3 corners = Uvec3Array(push.triangles).at[triangle];
        const vec3 a = Vec3Array(push.positions).at[corners.x] - push.frame.origin;
        const vec3 b = Vec3Array(push.positions).at[corners.y] - push.frame.origin;
        const vec3 c = Vec3Array(push.positions).at[corners.z] - push.frame.origin;
        const float near = kDirectional ? 0 : nearest(a, b, c);
        [[unroll]] for (uint face = 0; face < kViews; ++face) {
            const vec3 qa = view_coordinates(push.frame, face, a);
            const vec3 qb = view_coordinates(push.frame, face, b);
            const vec3 qc = view_coordinates(push.frame, face, c);
            const bool seen = own && reaches(qa, qb, qc);
            list_caster(face, seen, triangle);
            if (!seen) continue;
            const vec3 lowest = min(min(qa, qb), qc), highest = max(max(qa, qb), qc);
            vec2 lower = lowest.xy, upper = highest.xy;
            if (!kDirectional) {
                const vec2 sa = on_plane(qa), sb = on_plane(qb), sc = on_plane(qc);
                const bool behind = !(lowest.z > 0);
                lower = behind ? vec2(-push.reach)
                               : clamp(min(min(sa, sb), sc), -push.reach, push.reach);
                upper = behind ? vec2(push.reach)
                               : clamp(max(max(sa, sb), sc), -push.reach, push.reach);
            }
            const uint at = face * kBounds;
            bounds[at + kNear] = min(bounds[at + kNear], kDirectional ? lowest.z : near);
            bounds[at + kMinusFar] = min(bounds[at + kMinusFar], -highest.z);
            bounds[at + kLeft] = min(bounds[at + kLeft], lower.x);
            bounds[at + kTop] = min(bounds[at + kTop], lower.y);
            bounds[at + kMinusRight] = min(bounds[at + kMinusRight], -upper.x);
            bounds[at + kMinusBottom] = min(bounds[at + kMinusBottom], -upper.y);
        }
    }
    [[unroll]] for (uint i = 0; i < kViews * kBounds; ++i) {
        const float least = subgroupMin(bounds[i]);
        if (subgroupElect() && least < kLargest)
            atomicMin(FitRef(push.fit).at.bounds[i], ordered(least));
    }
}
