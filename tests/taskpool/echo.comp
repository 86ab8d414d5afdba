// Adds a specialised constant to a row of words: the smallest kernel that uses every part of the
// runtime (push constants, specialisation, buffer addresses, subgroup size).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kAdd = 0;
layout(push_constant, scalar) uniform Push {
    UintArray source;
    UintArray target;
    uint count;
} push;

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize)
        push.target.at[i] = push.source.at[i] + kAdd;
}
