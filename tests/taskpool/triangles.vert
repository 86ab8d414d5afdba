// Triangles given in clip coordinates, fetched by address.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
layout(push_constant, scalar) uniform Push { FloatArray corners; };
layout(location = 0) flat out uint triangle;

void main() {
    uint at = 4u * uint(gl_VertexIndex);
    gl_Position = vec4(corners.at[at], corners.at[at + 1], corners.at[at + 2], corners.at[at + 3]);
    triangle = uint(gl_VertexIndex) / 3u;
}
