// Shadow query, one packet per subgroup and slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/bvh/packet.glsl"

void main() {
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
