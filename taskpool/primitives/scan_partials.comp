// Scan, step 2 of 3: one subgroup turns the sums of the blocks into the sums before them, in place.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "taskpool/primitives/primitives_shared.h"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Block { ScanPush push; };

void main() {
    UintArray partials = UintArray(push.partials);
    uint before = 0;
    for (uint step = 0; step < push.block_count; step += gl_SubgroupSize) {
        uint i = step + gl_SubgroupInvocationID;
        uint own = i < push.block_count ? partials.at[i] : 0;
        uint prefix = subgroupExclusiveAdd(own);
        if (i < push.block_count) partials.at[i] = before + prefix;
        before += subgroupAdd(own);
    }
}
