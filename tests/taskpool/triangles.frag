// Writes the triangle's number, raised by a specialised constant.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
layout(constant_id = 1) const uint kAdd = 0;
layout(location = 0) flat in uint triangle;
layout(location = 0) out uint id;

void main() { id = triangle + kAdd; }
