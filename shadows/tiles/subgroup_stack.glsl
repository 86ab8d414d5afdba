// A traversal stack shared by a subgroup: in registers across it, entry i in lane i % size, so that
// no memory is touched.
#ifndef SHADOWS_BVH_SUBGROUP_STACK_GLSL
#define SHADOWS_BVH_SUBGROUP_STACK_GLSL

const uint kStackRegisters = 4u;
uint stack_part[kStackRegisters];
uint stack_depth;

uint stack_capacity() { return min(kStackLimit, kStackRegisters * kLanes); }

void stack_push(uint entry) {
    [[unroll]] for (uint r = 0; r < kStackRegisters; ++r)
        if (stack_depth == r * kLanes + lane()) stack_part[r] = entry;
    ++stack_depth;
}

uint stack_pop() {
    --stack_depth;
    uint part = stack_part[0];
    [[unroll]] for (uint r = 1; r < kStackRegisters; ++r)
        if (stack_depth / kLanes == r) part = stack_part[r];
    return subgroupShuffle(part, stack_depth % kLanes);
}

#endif
