// Shadow query, one beam per tile: see shadows/beam/beam.glsl. What it leaves goes on in packets.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
layout(constant_id = 7) const uint kListLimit = 1024u;  // triangles collected before they are tested
layout(constant_id = 8) const uint kTrianglesPerPoint = 3u;  // that a group may meet
#include "shadows/beam/beam.glsl"

vec3 beam_point(uint point) { return position_of(point); }
uint beam_primitive(uint point) { return primitive_of(point); }

#include "shadows/bvh/packet.glsl"
#include "shadows/bvh/walk.glsl"

void main() {
    beam_light = push.light;
    const WideHeader header = push.header.header;
    const vec3 origin = kDirectional ? 0.5 * header.origin + 0.5 * header.upper : push.light;
    const vec3 farthest = max(abs(header.upper - origin), abs(header.origin - origin));
    const float size = max(max(farthest.x, farthest.y), farthest.z);
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
