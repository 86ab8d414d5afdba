// Enters the points' depths into the finest level of the map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/receivers.glsl"

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        if (floatBitsToUint(push.points.at[3 * push.count + i]) == kNoPrimitive) continue;
        const vec3 p = vec3(push.points.at[i], push.points.at[push.count + i],
                            push.points.at[2 * push.count + i]);
        const Question question = question_of(push.frame, p);
        uint face = 0;
        vec2 place;
        if (kDirectional) {
            place = question.center.xy / push.frame.delta;
        } else {
            const vec3 size = abs(question.center);
            const uint axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2)
                                               : (size.y >= size.z ? 1 : 2);
            face = 2 * axis + (question.center[axis] < 0 ? 1 : 0);
            const vec3 q = to_face(question.center, face);
            place = q.xy / q.z;
        }
        const vec2 texel = clamp(vec2(texel_of(place.x), texel_of(place.y)), vec2(0),
                                 vec2(kMapSide - 1));
        // Bits order like floats that are not negative; before the scene nothing shadows a point.
        const uint word = texel_word(face, 0, uvec2(texel));
        const uint bits = floatBitsToUint(max(question.depth, 0.0));
        if (push.map.at[word] < bits) atomicMax(push.map.at[word], bits);
    }
}
