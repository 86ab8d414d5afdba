// metric.glsl on pairs of elements: what the tests compare with metric.hpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
layout(local_size_x_id = 0) in;
#include "structures/metric_tree/metric_tree_shared.h"
layout(constant_id = 1) const bool kDirectional = false;
const bool kCapsules = true;
#include "structures/metric_tree/metric.glsl"

struct Pair {
    Element pivot, element;
};
struct Answer {
    float at_a, low, high, middle;  // at_a: from the pivot to the element's first end
};
scalar_buffer(4) PairArray { Pair at[]; };
scalar_buffer(4) AnswerArray { Answer at[]; };
layout(push_constant, scalar) uniform Push {
    PairArray pairs;
    AnswerArray answers;
    uint count;
}
push;

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const Pair pair = push.pairs.at[i];
        Answer answer;
        answer.at_a = distance_to(pair.element.a, pair.pivot.a, pair.pivot.b);
        const vec2 reach = reach_of(pair.pivot, pair.element, answer.middle);
        answer.low = reach.x;
        answer.high = reach.y;
        push.answers.at[i] = answer;
    }
}
