// Scan, step 1 of 3: the sum of each block, or (kFlags) how many of its words are not 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "taskpool/primitives/primitives_shared.h"
#include "taskpool/primitives/quad.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool kFlags = false;
layout(push_constant, scalar) uniform Block { ScanPush push; };

void main() {
    uint begin = gl_WorkGroupID.x * push.block_length;
    uint end = block_end(gl_WorkGroupID.x, push.block_length, push.count);
    uint lane_sum = 0;
    for (uint step = begin; step < end; step += gl_SubgroupSize * kLaneWords) {
        uint first = step + gl_SubgroupInvocationID * kLaneWords;
        uvec4 words = load_quad(UintArray(push.source), first, end);
        lane_sum += sum(kFlags ? as_flags(words) : words);
    }
    uint block_sum = subgroupAdd(lane_sum);
    if (subgroupElect()) UintArray(push.partials).at[gl_WorkGroupID.x] = block_sum;
}
