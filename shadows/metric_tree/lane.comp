// Shadow query of a metric tree, one segment per lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/query.glsl"
#include "shadows/metric_tree/lane.glsl"

void main() { answer_by_lanes(); }
