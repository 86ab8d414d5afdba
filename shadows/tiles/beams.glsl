// One beam per tile (shadows/beam/beam.glsl); what beams leave goes on in packets. Hooks: those of
// packets.glsl, and of beam.glsl
//     CornerTriangle beam_triangle(uint index)
//     void beam_walk()
#ifndef SHADOWS_TILES_BEAMS_GLSL
#define SHADOWS_TILES_BEAMS_GLSL
layout(constant_id = 8) const uint kTrianglesPerPoint = 3u;  // that a group may meet
#include "shadows/beam/beam.glsl"
#include "shadows/tiles/packets.glsl"

vec3 beam_point(uint point) { return position_of(point); }
uint beam_primitive(uint point) { return primitive_of(point); }

// `origin` and `size` as in answer_tile().
void answer_by_beams(vec3 origin, float size) {
    beam_light = push.light;
    uint taken = 0, stack_full = 0, step_limit = 0, packet_tiles = 0;
    uint exact_tests = 0, groups = 0;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        const TileAnswer beams = answer_tile(tile, origin, size);
        uint occluded = beams.occluded;
        const bool left = subgroupAny(beams.left != 0);
        if (kStatistics || left) {
            // Where loops are cut, the beams' own steps count.
            uint steps = kLoopsAreCut ? kStepLimit - min(kStepLimit, beam_steps) : kStepLimit;
            const PacketAnswer packets =
                answer_packets(tile, beams.left, steps, PointCost(beam_nodes, beam_triangles));
            occluded |= packets.occluded;
            defer(tile, packets.deferred);
            stack_full += packets.stack_full;
            step_limit += packets.step_limit;
            packet_tiles += left ? 1 : 0;
        }
        store_tile(push.visible, tile, ~occluded);
        stack_full += beams.stack_full;
        exact_tests += beams.exact_tests;
        groups += beams.groups;
    }
    count_decisions();
    if (kStatistics) exact_tests = subgroupAdd(exact_tests);
    if (lane() == 0) {
        atomicAdd(push.status.at.stack_full, stack_full);
        atomicAdd(push.status.at.step_limit, step_limit);
        atomicAdd(push.status.at.packet_tiles, packet_tiles);
        if (kStatistics) {
            atomicAdd(push.status.at.exact_tests, exact_tests);
            atomicAdd(push.status.at.groups, groups);
        }
    }
}

#endif
