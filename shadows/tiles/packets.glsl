// Packets: a subgroup's segments, neighbours on the screen, walk together wherever one of them has to
// go. Hook:
//     bool packet_occluded(Segment s, uint own_primitive, bool asked, inout Walk walk, out bool unsure)
// for all lanes; `asked`: this lane's answer counts; `unsure`: some triangle is left to the per-point
// walk, which matters if there is no hit. A packet that runs out of stack or steps goes there as a whole.
#ifndef SHADOWS_TILES_PACKETS_GLSL
#define SHADOWS_TILES_PACKETS_GLSL

bool packet_occluded(Segment segment, uint own_primitive, bool asked, inout Walk walk,
                     out bool unsure);

struct PacketAnswer {
    uint occluded;    // slots
    uint deferred;    // slots without an answer
    uint stack_full;  // traversals given up because their stack was full
    uint step_limit;  // and because they took too many steps
};

// Answers `slots` of a tile, a packet at a time. `steps` are those that each traversal may take;
// `cost` is what the tile's points have cost before.
PacketAnswer answer_packets(uint tile, uint slots, inout uint steps, PointCost cost) {
    PacketAnswer answer = PacketAnswer(0, 0, 0, 0);
    for (uint k = 0; k < kSlots; ++k) {
        const bool asked = has_bit(slots, k);
        Walk walk = walk_begin(steps);
        if (subgroupAny(asked)) {
            const uint point = tile_point(tile, k);
            bool unsure;
            const bool hit =
                packet_occluded(segment_of(point), primitive_of(point), asked, walk, unsure);
            if (hit && asked) answer.occluded |= 1u << k;
            if (!hit && asked && (unsure || walk.end != kEndFinished)) answer.deferred |= 1u << k;
            answer.stack_full += walk.end == kEndStackFull ? 1 : 0;
            answer.step_limit += walk.end == kEndStepLimit ? 1 : 0;
            steps = steps_after(walk.steps);
        }
        if (kStatistics)
            push.costs.at[tile_point(tile, k)] =
                PointCost(cost.nodes + walk.nodes, cost.triangles + walk.triangles);
    }
    return answer;
}

void answer_by_packets() {
    uint taken = 0, stack_full = 0, step_limit = 0, steps = kStepLimit;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        uint slots = 0;
        [[unroll]] for (uint k = 0; k < kSlots; ++k)
            if (primitive_of(tile_point(tile, k)) != kNoPrimitive) slots |= 1u << k;
        const PacketAnswer answer = answer_packets(tile, slots, steps, PointCost(0, 0));
        store_tile(push.visible, tile, ~answer.occluded);
        defer(tile, answer.deferred);
        stack_full += answer.stack_full;
        step_limit += answer.step_limit;
    }
    count_decisions();
    if (lane() == 0) {
        atomicAdd(push.status.at.stack_full, stack_full);
        atomicAdd(push.status.at.step_limit, step_limit);
    }
}

#endif
