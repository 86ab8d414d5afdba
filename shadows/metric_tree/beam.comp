// Shadow query of a metric tree, one beam per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/query.glsl"
#include "shadows/tiles/beams.glsl"
#include "shadows/metric_tree/packet.glsl"
#include "shadows/metric_tree/beam.glsl"

void main() {
    const LightFrame frame = push.structure.header.header.frame;
    // The beam's scale becomes the frame's.
    answer_by_beams(frame.origin, 1.0 / frame.scale);
}
