// Shadow query of a metric tree, one packet per subgroup and slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/query.glsl"
#include "shadows/metric_tree/packet.glsl"

void main() { answer_by_packets(); }
