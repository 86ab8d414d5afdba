// The points of a tile and its bits, and reductions over a subgroup: part of beam.glsl, and of
// every kernel that works on tiles.
// A lane holds kSlots points; bit k of a mask stands for its slot k. Arrays are only indexed by
// unrolled loops, so that they stay in registers.
#ifndef SHADOWS_BEAM_POINTS_GLSL
#define SHADOWS_BEAM_POINTS_GLSL

const uint kTilePoints = 256u;
const uint kNoPrimitive = 0xffffffffu;
// Points per lane: kTilePoints / subgroup size. The size of arrays, hence not an expression of
// gl_WorkGroupSize, of which compilers take the default.
layout(constant_id = 9) const uint kSlots = 32;
const uint kLanes = kTilePoints / kSlots;
#include "taskpool/primitives/lanes.glsl"

float norm1(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

uint lane() { return gl_SubgroupInvocationID; }
uint tile_point(uint tile, uint k) {
    return tile * kTilePoints + k * kLanes + lane();
}
bool has_bit(uint bits, uint k) { return (bits >> k & 1u) != 0; }

// Takes the lowest lane out of a vote that is not empty.
uint take_lane(inout uvec4 votes) {
    if (kLanes <= 32 || votes.x != 0) {
        const uint lane = findLSB(votes.x);
        votes.x &= votes.x - 1u;
        return lane;
    }
    const uint lane = findLSB(votes.y);
    votes.y &= votes.y - 1u;
    return 32u + lane;
}

// Wide subgroups have reductions of their own.
float reduce_min(float value) { return kLanes > 16 ? subgroupMin(value) : lane_min(value); }
float reduce_max(float value) { return -reduce_min(-value); }
vec2 reduce_min(vec2 v) { return vec2(reduce_min(v.x), reduce_min(v.y)); }
vec2 reduce_max(vec2 v) { return vec2(reduce_max(v.x), reduce_max(v.y)); }
vec3 reduce_min(vec3 v) { return vec3(reduce_min(v.xy), reduce_min(v.z)); }
vec3 reduce_max(vec3 v) { return vec3(reduce_max(v.xy), reduce_max(v.z)); }
// Swaps index bits a < b of the positions in a word; `low` has the positions with a = 1, b = 0.
uint swap_index_bits(uint word, uint shift, uint low) {
    const uint difference = (word >> shift ^ word) & low;
    return word ^ difference ^ difference << shift;
}

// From each lane's mask of slots to words of 32 points in order: lane w gets word w.
uint tile_word(uint slots) {
    uint word = 0;
    if (kLanes == 8) {
        // A transposition of bits: 5 bits of slot index in a word, 3 of lane index. Three exchanges
        // swap the slot's upper bits with the lane's; the lane bits then move to the low end.
        [[unroll]] for (uint b = 0; b < 3; ++b) {
            const uint shift = 4u << b;
            const uint low = b == 0 ? 0x0f0f0f0fu : b == 1 ? 0x00ff00ffu : 0x0000ffffu;
            const uint other = subgroupShuffleXor(slots, 1u << b);
            slots = has_bit(lane(), b) ? (slots & ~low) | (other & ~low) >> shift
                                       : (slots & low) | (other & low) << shift;
        }
        slots = swap_index_bits(slots, 14, 0x0000ccccu);
        slots = swap_index_bits(slots, 7, 0x00aa00aau);
        slots = swap_index_bits(slots, 2, 0x0c0c0c0cu);
        return swap_index_bits(slots, 1, 0x22222222u);
    }
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const uvec2 vote = subgroupBallot(has_bit(slots, k)).xy;
        const uint first = k * kLanes;  // point within the tile
        if (lane() == first / 32) word |= vote.x << (first % 32);
        if (kLanes == 64 && lane() == first / 32 + 1) word |= vote.y;
    }
    return word;
}

// Writes a tile's bits: bit i of word w is point 32 w + i of the tile.
void store_tile(UintArray target, uint tile, uint slots) {
    const uint word = tile_word(slots);
    if (lane() < 8) target.at[tile * 8 + lane()] = word;
}

#endif
