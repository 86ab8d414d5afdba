// Distances between what the light sees: on the sphere of directions around a point light, or in the
// plane across a directional one. The includer defines kDirectional, and kCapsules: without, all
// elements are balls. metric.hpp is the same in C++.
//
// Every distance returned is off by less than kMetricError / 4 = 2^-20, for arcs of at most 90
// degrees and places in the plane at most 3.5 from its origin:
// - angles come from atan2 of products, never from acos: with e = 2^-24 the products err by a few e,
//   the arc tangent below by 1.9e-7 (its greatest error, found by trial of 4 * 10^5 angles);
// - the nearest point of an arc stems from e = b - a and is off along the arc by a few e, which moves
//   it by as much; the nearest point of a segment likewise.
#ifndef STRUCTURES_METRIC_TREE_METRIC_GLSL
#define STRUCTURES_METRIC_TREE_METRIC_GLSL

const float kPi = 3.14159265358979;

/// All directions, or places, within `radius` of the arc, or segment, from a to b.
struct Element {
    vec3 a, b;
    float radius;
};

/// Angle of (adjacent, opposite) against the first axis; opposite >= 0. 0 if both are 0.
float arc_tangent(float opposite, float adjacent) {
    const float along = abs(adjacent);
    const float less = min(along, opposite), more = max(along, opposite);
    if (!(more > 0)) return 0;
    // Up to tan(pi / 8) by a polynomial in z^2 that interpolates the series' rest at Chebyshev's
    // points; what is above comes down by pi / 4.
    const bool steep = less > 0.41421357 * more;
    const float z = steep ? (less - more) / (less + more) : less / more, q = z * z;
    const float series =
        ((0.08520492 * q - 0.14024143) * q + 0.19991238) * q - 0.33333287;
    float angle = z + z * q * series + (steep ? 0.25 * kPi : 0.0);
    angle = opposite > along ? 0.5 * kPi - angle : angle;
    return adjacent < 0 ? kPi - angle : angle;
}

float distance_between(vec3 p, vec3 q) {
    if (kDirectional) return length(p - q);
    return arc_tangent(length(cross(p, q)), dot(p, q));
}

/// From p, of any length but 0 (a place in the plane has z = 0), to the arc or segment from a to b.
float distance_to(vec3 p, vec3 a, vec3 b) {
    const vec3 e = b - a;
    const float ee = dot(e, e);
    if (!kCapsules || !(ee > 0)) return distance_between(p, a);
    float t;
    if (kDirectional) {
        t = clamp(dot(p - a, e) / ee, 0.0, 1.0);
    } else {
        // The stationary point of p . q / |q| over q = a + t e.
        const float ae = dot(a, e), pa = dot(p, a), pe = dot(p, e);
        const float den = pa * ee - pe * ae;
        if (den > 0) {
            t = clamp((pe * dot(a, a) - pa * ae) / den, 0.0, 1.0);
        } else {
            // That point is the farthest. Which end is nearer only their cotangents say: opposite p
            // all cosines are alike.
            t = dot(p, b) * length(cross(p, a)) > pa * length(cross(p, b)) ? 1.0 : 0.0;
        }
    }
    return distance_between(p, a + t * e);
}

/// The middle of an element's arc or segment.
vec3 middle_of(Element element) { return 0.5 * (element.a + element.b); }

/// Least and greatest distance from the pivot's arc to points of `element`, errors included: what a
/// query at one of the element's points may find. `middle` is the distance to the element's middle.
///
/// Distance to a set changes no faster than the way walked: along a way of length l with distances d
/// and d' at its ends it stays within (d + d' -+ l) / 2. That is taken for both halves of the arc; the
/// error of its four terms is below three quarters of kMetricError, which leaves one for the query.
vec2 reach_of(Element pivot, Element element, out float middle) {
    middle = distance_to(middle_of(element), pivot.a, pivot.b);
    vec2 reach = vec2(middle);
    if (kCapsules && element.a != element.b) {
        const float half_length = 0.5 * distance_between(element.a, element.b);
        const float at_a = distance_to(element.a, pivot.a, pivot.b);
        const float at_b = distance_to(element.b, pivot.a, pivot.b);
        reach.x = 0.5 * (middle + min(at_a, at_b) - half_length);
        reach.y = 0.5 * (middle + max(at_a, at_b) + half_length);
    }
    reach += vec2(-1, 1) * (element.radius + kMetricError);
    return vec2(max(reach.x, 0.0), reach.y);
}

#endif
