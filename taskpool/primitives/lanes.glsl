// Reductions and sums over a subgroup's lanes by exchange: cheaper than a driver's own on narrow subgroups,
// and lavapipe makes loops of those. The includer defines the constant kLanes, a power of two up to 128.
//
// Loops over hops of 1, 2, 4 ... lanes run over the logarithm: Mesa before 23 unrolls no loop whose
// variable is multiplied or divided, and nobody would count its iterations.
#ifndef TASKPOOL_PRIMITIVES_LANES_GLSL
#define TASKPOOL_PRIMITIVES_LANES_GLSL

const uint kLaneBits = 7;

/// Sum of the values of this lane and of those below.
uint sum_to_here(uint value) {
    [[unroll]] for (uint k = 0; k < kLaneBits; ++k) {
        const uint apart = 1u << k;
        if (apart < kLanes) {
            const uint other = subgroupShuffle(value, gl_SubgroupInvocationID - apart);
            value += gl_SubgroupInvocationID < apart ? 0 : other;
        }
    }
    return value;
}
uint lane_sum(uint value) { return subgroupShuffle(sum_to_here(value), kLanes - 1); }

float lane_min(float value) {
    [[unroll]] for (uint k = 0; k < kLaneBits; ++k)
        if (1u << k < kLanes) value = min(value, subgroupShuffleXor(value, 1u << k));
    return value;
}
float lane_max(float value) { return -lane_min(-value); }
uint lane_max(uint value) {
    [[unroll]] for (uint k = 0; k < kLaneBits; ++k)
        if (1u << k < kLanes) value = max(value, subgroupShuffleXor(value, 1u << k));
    return value;
}

#endif
