// Shadow query, one segment per lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/any_hit.glsl"

void main() { answer_by_lanes(); }
