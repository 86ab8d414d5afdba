// The points of a tile and its bits, and reductions over a subgroup: part of beam.glsl, and of every
// kernel that works on tiles.
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

uint lane() { return gl_SubgroupInvocationID; }
uint tile_point(uint tile, uint k) {
    return tile * kTilePoints + k * kLanes + lane();
}
bool has_bit(uint bits, uint k) { return (bits >> k & 1u) != 0; }

// Reductions by exchange are cheaper than the driver's own on narrow subgroups.
float reduce_min(float value) {
    if (kLanes > 16) return subgroupMin(value);
    [[unroll]] for (uint step = 1; step < 16; step *= 2) {
        if (step < kLanes) value = min(value, subgroupShuffleXor(value, step));
    }
    return value;
}
float reduce_max(float value) { return -reduce_min(-value); }
vec2 reduce_min(vec2 v) { return vec2(reduce_min(v.x), reduce_min(v.y)); }
vec2 reduce_max(vec2 v) { return vec2(reduce_max(v.x), reduce_max(v.y)); }
vec3 reduce_min(vec3 v) { return vec3(reduce_min(v.xy), reduce_min(v.z)); }
vec3 reduce_max(vec3 v) { return vec3(reduce_max(v.xy), reduce_max(v.z)); }
// Word `w` of a tile's bits, from each lane's mask of slots: bit i is point 32 w + i of the tile.
uint tile_word(uint slot_bits, uint w) {
    if (kLanes <= 32) {
        const uint per_word = 32 / kLanes;
        uint bits = 0;
        [[unroll]] for (uint i = 0; i < per_word; ++i)
            bits |= ((slot_bits >> (w * per_word + i)) & 1u) << (i * kLanes + lane());
        return subgroupOr(bits);
    }
    return subgroupBallot(has_bit(slot_bits, w / 2))[w & 1u];
}

// Writes a tile's bits: lane w writes word w.
void store_tile(UintArray target, uint tile, uint slot_bits) {
    uint mine = 0;
    [[unroll]] for (uint w = 0; w < 8; ++w) {
        const uint word = tile_word(slot_bits, w);
        if (lane() == w) mine = word;
    }
    if (lane() < 8) target.at[tile * 8 + lane()] = mine;
}

#endif
