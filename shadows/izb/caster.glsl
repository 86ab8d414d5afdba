// A triangle as seen from the light: which directions it may cover, and linear functions that tell
// points it certainly occludes from those it certainly does not.
//
// Each function is scaled so that its error is 1; where that would overflow it is 0, which is
// always in doubt. Error bounds: those of edges are in beam/edges.glsl, whose notation goes on
// here.
//   Footprint. Corners' own roundings, those of the points' u and v, and a quotient move a corner
//   by D, at most 16 e S, as seen from a point. In front of the light, z > 2 D, it projects off by
//   at most (1 + |u|) D / (z - D) <= 2 (1 + |u|) D / z. The cone of a triangle lies beyond x = s z
//   if all corners are beyond it by (1 + |s|) D, and is empty if all z < -D.
//   Plane N = (b - a) x (c - a): N is off by 5 e |b - a| |c - a|, so w = N . a, or N . (tilt, 1),
//   the side of the light, by 13 e |b - a| |c - a| times |a|, or |(tilt, 1)|; with the roundings
//   of u, v and k, of products and sums, N . d - w, the side of the point, by 20 e |b - a| |c - a|
//   (|a| + |d|).
// The factors below are at least twice these.
#ifndef SHADOWS_IZB_CASTER_GLSL
#define SHADOWS_IZB_CASTER_GLSL
#include "shadows/izb/frame.glsl"

const float kPlaneError = 2.0 * kEdgeError;

struct Corners {
    vec3 a, b, c;     // in the frame
    vec3 ab, bc, ca;  // differences, each with a single rounding
};

struct Caster {
    vec3 ab, bc, ca;  // factors of u, v, 1: of one sign inside, in front of the light the positive
    vec4 plane;       // factors of u, v, 1, k: positive for points it separates from the light
    float certain;    // like the last of these, which makes an upper bound, for a lower bound
};

struct Rectangle {
    vec2 lower, upper;
};

Corners corners_of(CornerTriangle t, vec3 origin, float scale, uint face) {
    return Corners(to_face((t.a - origin) * scale, face), to_face((t.b - origin) * scale, face),
                   to_face((t.c - origin) * scale, face), to_face((t.b - t.a) * scale, face),
                   to_face((t.c - t.b) * scale, face), to_face((t.a - t.c) * scale, face));
}

// Narrows `r` to what the triangle may cover of it; false if that is nothing.
bool footprint(Corners t, vec2 tilt, float reach, inout Rectangle r) {
    const float slack = kEdgeError * (max(max(norm1(t.a), norm1(t.b)), norm1(t.c)) + reach);
    vec2 margin;
    if (kDirectional) {
        margin = slack * (1.0 + abs(tilt));
    } else {
        if (max(max(t.a.z, t.b.z), t.c.z) < -slack) return false;
        const vec2 most =
            max(max(t.a.xy - r.lower * t.a.z, t.b.xy - r.lower * t.b.z), t.c.xy - r.lower * t.c.z);
        const vec2 least =
            min(min(t.a.xy - r.upper * t.a.z, t.b.xy - r.upper * t.b.z), t.c.xy - r.upper * t.c.z);
        if (any(lessThan(most, -slack * (1.0 + abs(r.lower)))) ||
            any(greaterThan(least, slack * (1.0 + abs(r.upper)))))
            return false;
        const float nearest = min(min(t.a.z, t.b.z), t.c.z);
        if (!(nearest > 2.0 * slack)) return true;
        const vec2 widest =
            max(max(abs(across(t.a, tilt)), abs(across(t.b, tilt))), abs(across(t.c, tilt)));
        margin = 2.0 * (1.0 + widest) * slack / nearest;
    }
    const vec2 a = across(t.a, tilt), b = across(t.b, tilt), c = across(t.c, tilt);
    r.lower = max(r.lower, min(min(a, b), c) - margin);
    r.upper = min(r.upper, max(max(a, b), c) + margin);
    return all(lessThanEqual(r.lower, r.upper));
}

// The functions of a triangle for points in rectangle `r`, no farther than `reach`.
Caster make_caster(Corners t, vec2 tilt, Rectangle r, float reach) {
    const vec2 centre = 0.5 * r.lower + 0.5 * r.upper, half_size = 0.5 * (r.upper - r.lower);
    const vec2 outermost = max(abs(r.lower), abs(r.upper));
    const float widest = outermost.x + outermost.y + (kDirectional ? 0.0 : 1.0);
    const float sa = norm1(t.a) + reach, sb = norm1(t.b) + reach, sc = norm1(t.c) + reach;
    const float xa = spread(t.a, tilt, centre, half_size),
                xb = spread(t.b, tilt, centre, half_size),
                xc = spread(t.c, tilt, centre, half_size);
    const vec3 normal = cross(t.ab, -t.ca);
    const float size = norm1(t.ab) * norm1(t.ca), length_a = norm1(t.a);
    const float w = dot(normal, t.a);
    const float facing = kDirectional ? dot(normal, vec3(tilt, 1)) : w;
    const float facing_error =
        kPlaneError * size * (kDirectional ? 1.0 + abs(tilt.x) + abs(tilt.y) : length_a);
    Caster caster;
    // The exact plane test tells front from back of a triangle for the light if this does.
    if (abs(facing) > facing_error) {
        const float side = facing < 0 ? -1.0 : 1.0;
        if (kDirectional) {
            const float scale = certainty(kPlaneError * size * (length_a + reach));
            caster.plane = -side * scale * vec4(normal.xy, -w, facing);
            caster.certain = caster.plane.w;
        } else {
            const float scale = certainty(kPlaneError * size * widest);
            caster.plane = side * scale * vec4(normal, -w);
            caster.certain = caster.plane.w - scale * facing_error;
            caster.plane.w += scale * facing_error;
        }
    } else {
        caster.plane = vec4(0);
        caster.certain = 0;
    }
    const float inside = facing < 0 ? -1.0 : 1.0;
    caster.ab = edge_function(t.a, t.ab, tilt) * inside *
                certainty(edge_error(sa, xa, sb, xb, norm1(t.a), norm1(t.ab), widest));
    caster.bc = edge_function(t.b, t.bc, tilt) * inside *
                certainty(edge_error(sb, xb, sc, xc, norm1(t.b), norm1(t.bc), widest));
    caster.ca = edge_function(t.c, t.ca, tilt) * inside *
                certainty(edge_error(sc, xc, sa, xa, norm1(t.c), norm1(t.ca), widest));
    return caster;
}

vec2 range_of(vec3 f, Rectangle r) { return range_of(f, r.lower, r.upper); }

// Whether the triangle may occlude a point in the rectangle whose k is `smallest_key` or more.
// The plane's function falls as k grows.
bool may_occlude(Caster caster, Rectangle r, float smallest_key) {
    const vec2 ab = range_of(caster.ab, r), bc = range_of(caster.bc, r),
               ca = range_of(caster.ca, r);
    const float outside = min(min(ab.y, bc.y), ca.y), other = max(max(ab.x, bc.x), ca.x);
    const float side = range_of(caster.plane.xyz, r).y + caster.plane.w * smallest_key;
    return !(outside < -1.0 && other > 1.0) && !(side < -1.0);
}

const uint kMiss = 0u, kDoubt = 1u, kHit = 2u;

uint classify(Caster caster, float u, float v, float k) {
    const float ab = caster.ab.x * u + (caster.ab.y * v + caster.ab.z);
    const float bc = caster.bc.x * u + (caster.bc.y * v + caster.bc.z);
    const float ca = caster.ca.x * u + (caster.ca.y * v + caster.ca.z);
    const float across_plane = caster.plane.x * u + (caster.plane.y * v + caster.plane.z);
    const float least = min(min(ab, bc), ca), most = max(max(ab, bc), ca);
    if ((least < -1.0 && most > 1.0) || across_plane + caster.plane.w * k < -1.0) return kMiss;
    const bool behind = across_plane + caster.certain * k > 1.0 && k < kLargestKey;
    return least > 1.0 && behind ? kHit : kDoubt;
}

Caster broadcast(Caster caster, uint from) {
    caster.ab = subgroupShuffle(caster.ab, from);
    caster.bc = subgroupShuffle(caster.bc, from);
    caster.ca = subgroupShuffle(caster.ca, from);
    caster.plane = subgroupShuffle(caster.plane, from);
    caster.certain = subgroupShuffle(caster.certain, from);
    return caster;
}

// The rectangle of a block of cells, wide enough to hold their points.
Rectangle cells_rectangle(vec2 lower, vec2 cell, vec2 pad, uvec2 first, uvec2 last) {
    return Rectangle(lower + vec2(first) * cell - pad, lower + vec2(last + 1u) * cell + pad);
}
Rectangle cells_rectangle(uint face, uvec2 first, uvec2 last) {
    return cells_rectangle(push.frame.at.faces[face].lower, push.frame.at.faces[face].cell,
                           push.frame.at.faces[face].pad, first, last);
}

#endif
