// Shadow query of a metric tree, points that the others left over.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/query.glsl"
#include "shadows/metric_tree/lane.glsl"

void main() { answer_deferred(); }
