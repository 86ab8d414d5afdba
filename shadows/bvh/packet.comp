// Shadow query, one packet per subgroup and slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/packet.glsl"

void main() { answer_by_packets(); }
