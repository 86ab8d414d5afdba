// Shadow query, points that packets and beams left over.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/any_hit.glsl"

void main() { answer_deferred(); }
