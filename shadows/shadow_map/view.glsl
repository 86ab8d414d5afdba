// Where a place lies on a shadow map: one convention for the rasteriser and the lookup.
//
//     vec3 q = view_coordinates(frame, face, p - frame.origin);
//     vec2 place = view.scale * on_plane(q) + view.offset;       // -1 to 1 across the map
//     float depth = depth_at(view, q.z);                         // nearer is larger
//
// Point light: face 2 a looks along axis a, face 2 a + 1 against it. Its coordinates are the next
// two axes in cyclic order and the distance w along its own; a place belongs to the face with the
// largest w, and is at s = (x, y) / w, from -1 to 1. These are exchanges of coordinates, free of
// rounding. Every other face is a mirror image, which matters to nobody: triangles cast on both
// sides. Depth is near / w: linear on a map over a plane, and of the same relative precision at
// every distance, so that a far plane would gain nothing.
//
// Directional light: one map, an orthonormal frame, s = (x, y), depth linear in w.
#ifndef SHADOWS_SHADOW_MAP_VIEW_GLSL
#define SHADOWS_SHADOW_MAP_VIEW_GLSL
#include "shadows/shadow_map/view_shared.h"

layout(constant_id = 1) const bool kDirectional = false;

// The face that looks towards r; of several, the first axis.
uint face_towards(vec3 r) {
    if (kDirectional) return 0;
    const vec3 size = abs(r);
    const uint axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (r[axis] < 0 ? 1 : 0);
}

vec3 view_coordinates(Frame frame, uint face, vec3 r) {
    if (kDirectional) return vec3(dot(frame.right, r), dot(frame.down, r), dot(frame.forward, r));
    const vec3 q = face < 2 ? r.yzx : face < 4 ? r.zxy : r;
    return vec3(q.xy, (face & 1) == 0 ? q.z : -q.z);
}

vec2 on_plane(vec3 q) { return kDirectional ? q.xy : q.xy / q.z; }

float depth_at(View view, float w) {
    return kDirectional ? view.near - view.per_depth * w : view.near / w;
}

#endif
