// The map of receivers.hpp. On a face of the cube around a point light a direction has coordinates s, t
// = its other two components over the largest; across a directional light there is one face, places over
// the disc's radius. Either way from -1 to 1.
#include "taskpool/gpu/device.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const bool kDirectional = false;
layout(constant_id = 24) const bool kCapsules = true;
#include "shadows/metric_tree/question.glsl"
#include "shadows/metric_tree/receivers_shared.h"

layout(push_constant, scalar) uniform Push {
    LightFrame frame;
    UintArray map;      // per face, level by level: bits of the greatest depth; 0: no receiver
    FloatArray points;  // planes x, y, z, primitive of point_count words each
    Clusters clusters;
    UintArray keep;     // a bit per cluster
    uint count;         // of points, texels or clusters
    uint level;
} push;

uint level_side(uint level) { return kMapSide >> level; }
uint level_start(uint level) {
    // The levels before have side^2 (1 + 1/4 + ...) texels.
    const uint side = level_side(level);
    return (4 * kMapSide * kMapSide - 4 * side * side) / 3;
}
uint texel_word(uint face, uint level, uvec2 texel) {
    return face * kFaceTexels + level_start(level) + texel.y * level_side(level) + texel.x;
}

/// (s, t, w) of face `face`: w is the component along its axis.
vec3 to_face(vec3 v, uint face) {
    const uint axis = face / 2;
    const vec3 last = axis == 0 ? v.yzx : axis == 1 ? v.zxy : v;
    return vec3(last.xy, face % 2 == 0 ? last.z : -last.z);
}

/// Texel, unclamped, of a coordinate.
float texel_of(float s) { return (0.5 * s + 0.5) * float(kMapSide); }
