// Shadow query, one beam per tile: see shadows/beam/beam.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
layout(constant_id = 7) const uint kListLimit = 256u;  // triangles collected before they are tested
layout(constant_id = 8) const uint kRoundLimit = 12u;  // groups per tile
layout(constant_id = 10) const uint kSplitTriangles = 384u;  // that a group may meet before it is halved
#include "shadows/beam/beam.glsl"

vec3 beam_point(uint point) { return position_of(point); }
uint beam_primitive(uint point) { return primitive_of(point); }

#include "shadows/bvh/walk.glsl"

void main() {
    beam_light = push.light;
    const WideHeader header = push.header.header;
    const vec3 origin = kDirectional ? 0.5 * header.origin + 0.5 * header.upper : push.light;
    const vec3 farthest = max(abs(header.upper - origin), abs(header.origin - origin));
    const float size = max(max(farthest.x, farthest.y), farthest.z);
    uint taken = 0, finished = 0, ends[4] = uint[4](0, 0, 0, 0);
    uint exact_tests = 0, groups = 0;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        const TileAnswer answer = answer_tile(tile, origin, size);
        store_tile(push.visible, tile, ~answer.occluded);
        defer(tile, answer.deferred);
        finished += answer.ends == 0 ? 1 : 0;
        [[unroll]] for (uint end = 1; end < 4; ++end) ends[end] += answer.ends >> end & 1u;
        if (kStatistics) {
            exact_tests += answer.exact_tests;
            groups += answer.groups;
            [[unroll]] for (uint k = 0; k < kSlots; ++k)
                push.costs.at[tile_point(tile, k)] = PointCost(beam_nodes, beam_triangles);
        }
    }
    count_decisions();
    if (kStatistics) exact_tests = subgroupAdd(exact_tests);
    if (lane() == 0) {
        atomicAdd(push.status.at.finished_tiles, finished);
        atomicAdd(push.status.at.stack_full, ends[kBeamStackFull]);
        atomicAdd(push.status.at.step_limit, ends[kBeamStepLimit]);
        atomicAdd(push.status.at.round_limit, ends[kBeamRoundLimit]);
        if (kStatistics) {
            atomicAdd(push.status.at.exact_tests, exact_tests);
            atomicAdd(push.status.at.groups, groups);
        }
    }
}
