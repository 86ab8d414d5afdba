// Compaction, last step: each block writes what it keeps behind what the blocks before it keep.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "taskpool/primitives/primitives_shared.h"
#include "taskpool/primitives/quad.glsl"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Block { ScanPush push; };

void main() {
    UintArray target = UintArray(push.target);
    uint begin = gl_WorkGroupID.x * push.block_length;
    uint end = block_end(gl_WorkGroupID.x, push.block_length, push.count);
    uint before = push.block_count > 1 ? UintArray(push.partials).at[gl_WorkGroupID.x] : 0;
    for (uint step = begin; step < end; step += gl_SubgroupSize * kLaneWords) {
        uint first = step + gl_SubgroupInvocationID * kLaneWords;
        uvec4 flags = as_flags(load_quad(UintArray(push.source), first, end));
        uint lane_sum = sum(flags);
        uint prefix = subgroupInclusiveAdd(lane_sum);
        uint place = before + prefix - lane_sum;
        [[unroll]] for (uint k = 0; k < kLaneWords; ++k) {
            uint i = first + k;
            if (flags[k] != 0) {
                target.at[place] = push.values != 0 ? UintArray(push.values).at[i] : i;
                ++place;
            }
        }
        before += subgroupShuffle(prefix, gl_SubgroupSize - 1);
    }
    if (push.total != 0 && end == push.count && subgroupElect())
        UintArray(push.total).at[0] = before;
}
