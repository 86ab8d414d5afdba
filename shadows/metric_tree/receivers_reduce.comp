// One level of the map from the one below it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/receivers.glsl"

void main() {
    const uint side = level_side(push.level);
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uint face = i / (side * side), at = i % (side * side);
        const uvec2 texel = uvec2(at % side, at / side);
        uint deepest = 0;
        [[unroll]] for (uint k = 0; k < 4; ++k)
            deepest = max(deepest, push.map.at[texel_word(face, push.level - 1,
                                                          2 * texel + uvec2(k & 1, k >> 1))]);
        push.map.at[texel_word(face, push.level, texel)] = deepest;
    }
}
