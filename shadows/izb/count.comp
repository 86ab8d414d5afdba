// Which cell each point falls into, how many others came before it, and the smallest k of a cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const IzbFrame frame = push.frame.at;
    for (uint first = run_begin(); first < run_end(); first += gl_SubgroupSize) {
        const uint point = first + lane();
        const Projected q =
            project(position_of(point), frame.origin, frame.scale, frame.tilt, frame.face);
        uint cell = kNoCell;
        if (primitive_of(point) != kNoPrimitive && q.face < kFaces) {
            const vec2 lower = push.frame.at.faces[q.face].lower;
            const vec2 cells_per_unit = push.frame.at.faces[q.face].cells_per_unit;
            const uint log_width = push.frame.at.faces[q.face].log_width;
            const uint log_height = push.frame.at.faces[q.face].log_height;
            const vec2 at = max((vec2(q.u, q.v) - lower) * cells_per_unit, vec2(0));
            const uint x = min(uint(at.x), (1u << log_width) - 1u);
            const uint y = min(uint(at.y), (1u << log_height) - 1u);
            cell = push.frame.at.faces[q.face].level_first[0] + (y << log_width) + x;
            push.places.at[point] = atomicAdd(push.cells.at[cell], 1u);
            const uint key = ordered(q.k);
            // Most points are not the farthest: look before taking the slower way.
            if (push.farthest.at[cell] > key) atomicMin(push.farthest.at[cell], key);
        }
        push.keys.at[point] = cell;
    }
}
