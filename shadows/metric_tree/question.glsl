// What a point asks of a metric tree.
#ifndef SHADOWS_METRIC_TREE_QUESTION_GLSL
#define SHADOWS_METRIC_TREE_QUESTION_GLSL
#include "structures/metric_tree/tree.glsl"
#include "shadows/beam/points.glsl"

const float kRound = 9.5367431640625e-7;  // 2^-20: 16 roundings

/// Where the light sees the point, and how deep. A point within a rounding of the light asks for
/// nothing: its segment is empty, or too short to meet what is not there as well.
Question question_of(LightFrame frame, vec3 point) {
    const vec3 p = (point - frame.origin) * frame.scale;
    if (kDirectional) {
        // Outside the scene, places are less precise than within.
        const float error = kRound * norm1(p);
        return Question(vec3(dot(frame.right, p), dot(frame.up, p), 0), error,
                        dot(frame.forward, p) + frame.start + error);
    }
    const vec3 size = abs(p);
    const float largest = max(max(size.x, size.y), size.z);
    return Question(largest > 0 ? p / largest : p, 0.0, length(p) * (1.0 + kRound));
}

#endif
