// Floats as words of the same order: what atomicMin() of floats would need. NaN is beyond the
// infinities; -0 is just below 0. The host's way back is in ordered.hpp.
#ifndef TASKPOOL_PRIMITIVES_ORDERED_GLSL
#define TASKPOOL_PRIMITIVES_ORDERED_GLSL

uint ordered(float value) {
    const uint bits = floatBitsToUint(value);
    return bits ^ ((bits & 0x80000000u) != 0 ? 0xffffffffu : 0x80000000u);
}

float from_ordered(uint word) {
    return uintBitsToFloat(word ^ ((word & 0x80000000u) != 0 ? 0x80000000u : 0xffffffffu));
}

#endif
