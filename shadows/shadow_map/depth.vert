// Rendering a shadow map, step 2: the corners of the casters that fit.comp has listed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "shadows/shadow_map/view.glsl"
layout(push_constant, scalar) uniform Block { DepthPush push; };

void main() {
    const uint triangle = UintArray(push.casters).at[uint(gl_VertexIndex) / 3u];
    const uvec3 corners = Uvec3Array(push.triangles).at[triangle];
    const vec3 p = Vec3Array(push.positions).at[corners[uint(gl_VertexIndex) % 3u]];
    const vec3 q = view_coordinates(push.frame, push.face, p - push.frame.origin);
    const View view = push.view;
    if (kDirectional)
        gl_Position = vec4(view.scale * q.xy + view.offset, depth_at(view, q.z), 1);
    else
        gl_Position = vec4(view.scale * q.xy + view.offset * q.z, view.near, q.z);
}
