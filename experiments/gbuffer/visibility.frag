// Step 2 of the G-buffer: the primitive id of the nearest triangle at each pixel's centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "experiments/gbuffer/gbuffer_shared.h"
layout(push_constant, scalar) uniform Block { VisibilityPush push; };
layout(location = 0) flat in uint primitive;
layout(location = 1) flat in vec3 depth_plane;
layout(location = 2) flat in vec2 depth_range;
layout(location = 0) out uint id;

void main() {
    id = primitive;
    vec2 ndc = gl_FragCoord.xy * push.ndc_per_pixel - 1.0;
    gl_FragDepth = clamp(dot(depth_plane, vec3(ndc, 1)), depth_range.x, depth_range.y);
}
