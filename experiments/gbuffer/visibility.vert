// Step 1 of the G-buffer: where triangles are on the screen, and which depth each of their pixels
// has.
//
// The hardware interpolates depth from clipped vertices in single precision. Where a large triangle
// passes beneath the camera one of them lies on the near plane, and what is left of a distant
// pixel's depth is noise. So depth is not interpolated: with c_i the clip coordinates (x, y, w) of
// the corners, near / w is linear over the screen, near / w = g . (x_ndc, y_ndc, 1), and
//     g = near (c0 x c1 + c1 x c2 + c2 x c0) / det(c0, c1, c2)
// since g . c_i = near for each corner. The fragment shader evaluates it at the pixel's centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "experiments/gbuffer/gbuffer_shared.h"
layout(push_constant, scalar) uniform Block { VisibilityPush push; };
layout(location = 0) flat out uint primitive;
layout(location = 1) flat out vec3 depth_plane;
layout(location = 2) flat out vec2 depth_range;

// Only roundings depend on the order of operations, but corners shared by triangles must agree.
precise dvec3 clip_coordinates(uint vertex) {
    precise dvec3 r = dvec3(Vec3Array(push.positions).at[vertex]) - dvec3(push.eye);
    precise dvec3 clip =
        dvec3(dot(dvec3(push.row_x), r), dot(dvec3(push.row_y), r), dot(dvec3(push.row_w), r));
    return clip;
}

void main() {
    primitive = uint(gl_VertexIndex) / 3u;
    uint corner = uint(gl_VertexIndex) % 3u;
    uvec3 vertices = Uvec3Array(push.triangles).at[primitive];
    dvec3 c0 = clip_coordinates(vertices.x);
    dvec3 c1 = clip_coordinates(vertices.y);
    dvec3 c2 = clip_coordinates(vertices.z);
    dvec3 own = corner == 0u ? c0 : corner == 1u ? c1 : c2;
    gl_Position = vec4(float(own.x), float(own.y), push.near, float(own.z));

    // A triangle seen edge on (det 0) has depth 0, which no pixel accepts.
    dvec3 normal = cross(c0, c1) + cross(c1, c2) + cross(c2, c0);
    double det = dot(c0, cross(c1, c2));
    depth_plane = det == 0.0 ? vec3(0) : vec3(double(push.near) / det * normal);
    // A pixel's centre may miss the triangle by the rasteriser's rounding; a steep plane must not
    // leave the triangle's depths there. Corners behind the near plane have no depth: 1 bounds it.
    vec3 w = vec3(c0.z, c1.z, c2.z);
    vec3 depths = mix(push.near / w, vec3(1), lessThan(w, vec3(push.near)));
    depth_range = det == 0.0 ? vec2(0)
                             : vec2(min(min(depths.x, depths.y), depths.z),
                                    max(max(depths.x, depths.y), depths.z));
}
