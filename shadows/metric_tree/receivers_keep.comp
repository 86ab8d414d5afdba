// Keeps the clusters that may shadow a point of the map: somewhere in what the cluster covers, as the
// light sees it, there is a point no nearer than the cluster. A lane takes 32 of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/metric_tree/receivers.glsl"
#include "structures/metric_tree/elements.glsl"

/// Greatest depth in a rectangle of one face, in texels, which may stick out; 0 if nothing is there.
float deepest_within(uint face, vec2 lower, vec2 upper) {
    // A texel more on each side than roundings can amount to.
    const vec2 first = floor(lower) - 1.0, last = floor(upper) + 1.0;
    if (any(lessThan(last, vec2(0))) || any(greaterThan(first, vec2(kMapSide - 1)))) return 0;
    const uvec2 from = uvec2(max(first, vec2(0))), to = uvec2(min(last, vec2(kMapSide - 1)));
    // The level where the rectangle is at most two texels wide.
    const uvec2 size = to - from;
    const uint level = uint(findMSB(max(max(size.x, size.y), 1u)));
    const uvec2 a = from >> level, b = to >> level;
    uint deepest = 0;
    for (uint y = a.y; y <= b.y; ++y)
        for (uint x = a.x; x <= b.x; ++x)
            deepest = max(deepest, push.map.at[texel_word(face, level, uvec2(x, y))]);
    return uintBitsToFloat(deepest);
}

/// Range of s = x / z over all directions within an angle of (x, z) whose sine is `sine`, as far as z > 0:
/// turn the projection both ways. (1, -1) if there is none.
vec2 range_of(float x, float z, float sine) {
    const float size = length(vec2(x, z));
    if (size <= sine) return vec2(-1, 1);
    if (z <= -sine) return vec2(1, -1);
    const float s = sine / size, c = sqrt(max(1.0 - s * s, 0.0));
    const vec2 low = vec2(x * c - z * s, z * c + x * s), high = vec2(x * c + z * s, z * c - x * s);
    return vec2(low.y > 0 ? low.x / low.y : -1.0, high.y > 0 ? high.x / high.y : 1.0);
}

bool is_kept(Element element, float min_depth) {
    if (kDirectional) {
        const vec2 a = element.a.xy, b = element.b.xy;
        const vec2 lower = (min(a, b) - element.radius) / push.frame.delta;
        const vec2 upper = (max(a, b) + element.radius) / push.frame.delta;
        return deepest_within(0, vec2(texel_of(lower.x), texel_of(lower.y)),
                              vec2(texel_of(upper.x), texel_of(upper.y))) >= min_depth;
    }
    // A cone around the arc.
    const vec3 middle = normalize(middle_of(element));
    const float angle =
        max(distance_between(middle, element.a), distance_between(middle, element.b)) +
        element.radius + 2.0 * kMetricError;
    const float sine = angle < 0.5 * kPi ? angle : 2.0;  // no less than the sine
    for (uint face = 0; face < kFaces; ++face) {
        const vec3 c = to_face(middle, face);
        const vec2 s = range_of(c.x, c.z, sine), t = range_of(c.y, c.z, sine);
        if (s.x > s.y || t.x > t.y) continue;
        if (deepest_within(face, vec2(texel_of(s.x), texel_of(t.x)),
                           vec2(texel_of(s.y), texel_of(t.y))) >= min_depth)
            return true;
    }
    return false;
}

void main() {
    for (uint word = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID;
         32 * word < push.count; word += gl_NumWorkGroups.x * gl_SubgroupSize) {
        uint kept = 0;
        const uint end = min(push.count - 32 * word, 32u);
        for (uint k = 0; k < end; ++k) {
            Element element;
            float min_depth;
            const uint role = make_element(push.frame, push.clusters.at[32 * word + k], false, element,
                                           min_depth);
            if (role != kRoleElement || is_kept(element, min_depth)) kept |= 1u << k;
        }
        push.keep.at[word] = kept;
    }
}
