// Does a triangle block the segment from a receiver to the light? The last word of every
// structure's shadow query, so that all of them answer bit for bit alike.
//
//     Segment s = point_segment(p, light);             // or directional_segment(p, towards_light)
//     if (primitive != own && occludes(s, a, b, c)) ...
//
// Kernels that can put a point off may call occludes_quickly() and spare themselves the last resort,
// which a few pairs in a million need, but whose code slows down all.
//
// A hit is a proper crossing of the closed triangle, from either side, strictly between receiver
// and light. A segment in the triangle's plane hits nothing; neither does one that ends on it. The
// answer is that of exact arithmetic on the single-precision inputs, whatever device or compiler:
// a filter in single precision, here, decides nearly every triangle and passes on what its error
// bounds do not vouch for to exact_occlusion.glsl.
//
// The filter is that of Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", with
// bounds. Relative to p, with the dominant axis of D, the way to the light, as z, corners are
// sheared onto z's axis. Edge functions u, v, w then say whether the triangle covers the axis, and
// with them as weights, corners' depths t = z / D.z add up to the depth of the crossing.
//
// Bounds, with e = 2^-24; capitals are exact. Sums, differences and products are rounded once and
// quotients are off by 2.5 ulp = 5 e (Vulkan), relatively; on top of that, what is smaller than
// 2^-126 may be lost. Nothing is decided unless 2^-100 < |D.z| < 2^100, and `size` = `across` +
// `deepest` exceeds `slack` = 2^-100, so that these losses are below e size for a corner. The room
// between the sums below and the constants is for products of errors.
//   Corner: S = X - (D.x / D.z) Z, |D.x| <= |D.z|. Off by e each for X, Z, D.x, D.z, the product and
//     the difference, 5 e for the quotient: |s - S| <= 2 e |X| + 10 e |Z|, at most 12 e size, and
//     14 e size with losses. `deepest` is at least every |Z|; `across`, the largest |s.x| plus the
//     largest |s.y| of all corners, is at least every |s.x| + |s.y|; so `size` is at least every |X|.
//   Edge: moving two corners by d = 14 e size each changes their product by at most
//     2 d (across + d); its own roundings add 4 e |s.x| |s.y| <= e across^2. With area =
//     (across + 16 e size) size, |u - U| <= 29 e area. `error` is 32 e area + slack.
//   Crossing: |u + v + w| <= 1.5 across^2 <= 1.5 area, off by (3 * 29 + 3) e area. Depths t are off
//     by 9 e farthest, losses included, farthest = deepest / |D.z| >= |t|. So u t + v t + w t is off
//     by (3 * 29 + 9 * 1.5 + 3 * 1.5) e area farthest = 105 e area farthest. `near_error` and
//     `far_error`, for this sum and for its distance from u + v + w, allow 128 e area for each.
// Overflow makes a bound infinite, and so undecided; far_error < 1e32 keeps the sums finite.
// The bounds hold only for the operations as they are written, hence `precise`.
#ifndef SHADOWS_OCCLUSION_GLSL
#define SHADOWS_OCCLUSION_GLSL

struct Segment {
    vec3 origin;    // the receiver
    vec3 target;    // the light, or, if `directional`, the direction towards it
    vec3 shear;     // x and y per z, and 1 / z, of origin -> light in the order of the axes below
    float slack;    // 2^-100; infinite if single precision is to decide nothing
    int axis;       // dominant axis: 0, 1, 2
    bool directional;
};

#include "shadows/exact_occlusion.glsl"

// (x, y, z) such that the dominant axis comes last.
vec3 axis_last(vec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v; }

Segment make_segment(vec3 origin, vec3 target, vec3 towards, bool directional) {
    const vec3 size = abs(towards);
    Segment s;
    s.origin = origin;
    s.target = target;
    s.directional = directional;
    s.axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const vec3 d = axis_last(towards, s.axis);
    const bool divides = abs(d.z) > 7.888609e-31 && abs(d.z) < 1.2676506e30;
    precise vec3 shear = divides ? vec3(d.x / d.z, d.y / d.z, 1.0 / d.z) : vec3(0);
    s.shear = shear;
    s.slack = divides ? 7.888609e-31 : uintBitsToFloat(0x7f800000u);
    return s;
}

Segment point_segment(vec3 p, vec3 light) {
    precise vec3 towards = light - p;
    return make_segment(p, light, towards, false);
}

Segment directional_segment(vec3 p, vec3 towards) { return make_segment(p, towards, towards, true); }

// A corner relative to the segment's origin, its dominant axis last; and sheared onto that axis.
vec3 seen_from_origin(Segment s, vec3 corner) {
    precise vec3 r = axis_last(corner - s.origin, s.axis);
    return r;
}
vec2 sheared(Segment s, vec3 r) {
    precise vec2 across = r.xy - s.shear.xy * r.z;
    return across;
}

// 1, 0, or kUnsure: left to occludes_exactly().
int occludes_quickly(Segment s, vec3 a, vec3 b, vec3 c) {
    const vec3 ra = seen_from_origin(s, a), rb = seen_from_origin(s, b), rc = seen_from_origin(s, c);
    const vec2 sa = sheared(s, ra), sb = sheared(s, rb), sc = sheared(s, rc);
    precise float u = sc.x * sb.y - sc.y * sb.x;
    precise float v = sa.x * sc.y - sa.y * sc.x;
    precise float w = sb.x * sa.y - sb.y * sa.x;
    const vec2 reach = max(max(abs(sa), abs(sb)), abs(sc));
    precise float across = reach.x + reach.y;
    precise float deepest = max(max(abs(ra.z), abs(rb.z)), abs(rc.z)) + s.slack;
    precise float size = across + deepest;
    precise float error = (across + size * 9.5367431640625e-7) * size * 1.9073486328125e-6 + s.slack;
    const float least = min(min(u, v), w), most = max(max(u, v), w);
    if (least < -error && most > error) return 0;
    if (least > error || most < -error) {
        precise float depth = u * (ra.z * s.shear.z) + v * (rb.z * s.shear.z) + w * (rc.z * s.shear.z);
        precise float total = abs(u + v + w), scaled = least > 0 ? depth : -depth;
        precise float beyond = total - scaled;
        precise float near_error = 4.0 * error * (deepest * abs(s.shear.z)) + s.slack;
        precise float far_error = near_error + 4.0 * error;
        if (far_error < 1e32) {
            if (scaled > near_error && (s.directional || beyond > far_error)) return 1;
            if (scaled < -near_error || (!s.directional && beyond < -far_error)) return 0;
        }
    }
    return occludes_in_double(s, a, b, c);
}

bool occludes(Segment s, vec3 a, vec3 b, vec3 c) {
    const int quick = occludes_quickly(s, a, b, c);
    if (quick != kUnsure) return quick == 1;
    return occludes_exactly(s, a, b, c);
}

#endif
