// Tests ranges of points that test.comp left over against their entries' triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/test.glsl"

void main() {
    const vec3 origin = push.frame.at.origin;
    const float scale = push.frame.at.scale;
    const vec2 tilt = push.frame.at.tilt;
    test_count = exact_count = 0;
    const uint count = push.status.at.counts[kRanges];
    for (uint taken = 0; taken < kChunksPerGroup; ++taken) {
        uint first = 0;
        if (lane() == 0) first = atomicAdd(push.status.at.next_range, gl_SubgroupSize);
        first = subgroupBroadcastFirst(first);
        if (first >= count) break;
        const bool used = first + lane() < count;
        IzbRange range = IzbRange(0, 0, 0);
        if (used) range = push.ranges.at[first + lane()];
        const Held held = hold(range.entry, used, origin, scale, tilt);
        uvec4 votes = subgroupBallot(used);
        while (true) {
            const uint from = take_lane(votes);
            turn_to(held, from);
            test_points(subgroupShuffle(range.begin, from), subgroupShuffle(range.end, from));
            if (votes.xy == uvec2(0)) break;
        }
    }
    add_statistics();
}
