// Copies each point to its place in the order of cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const IzbFrame frame = push.frame.at;
    for (uint first = run_begin(); first < run_end(); first += gl_SubgroupSize) {
        const uint point = first + lane();
        const uint cell = push.keys.at[point];
        const Projected q =
            project(position_of(point), frame.origin, frame.scale, frame.tilt, frame.face);
        uint place = kNoCell;
        if (cell != kNoCell) {
            place = push.cells.at[cell] + push.places.at[point];
            push.binned.at[place] = IzbPoint(q.u, q.v, q.k, primitive_of(point));
            push.order.at[place] = point;
        }
        push.places.at[point] = place;
    }
}
