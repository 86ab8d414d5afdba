// Radix sort, first half of a pass: how often each digit occurs in each block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "taskpool/primitives/primitives_shared.h"
#include "taskpool/primitives/quad.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kKeyWords = 1;
layout(push_constant, scalar) uniform Block { SortPush push; };

const uint kDigits = 256;
shared uint counts[kDigits];

void main() {
    for (uint digit = gl_SubgroupInvocationID; digit < kDigits; digit += gl_SubgroupSize)
        counts[digit] = 0;
    barrier();
    uint begin = gl_WorkGroupID.x * push.block_length;
    uint end = block_end(gl_WorkGroupID.x, push.block_length, push.count);
    for (uint i = begin + gl_SubgroupInvocationID; i < end; i += gl_SubgroupSize) {
        uint digit = UintArray(push.keys).at[i * kKeyWords + push.word] >> push.shift & push.mask;
        atomicAdd(counts[digit], 1, gl_ScopeWorkgroup, gl_StorageSemanticsNone,
                  gl_SemanticsRelaxed);
    }
    barrier();
    for (uint digit = gl_SubgroupInvocationID; digit < kDigits; digit += gl_SubgroupSize)
        UintArray(push.histogram).at[digit * push.block_count + gl_WorkGroupID.x] = counts[digit];
}
