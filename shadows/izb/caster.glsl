// A triangle as seen from the light: which directions it may cover, and linear functions that tell
// points it certainly occludes from those it certainly does not.
//
// Homogeneous rasterisation (M. Olano and T. Greer, "Triangle scan conversion using 2D homogeneous
// coordinates", 1997): with corners a, b, c relative to the light and q = (u, v, 1), the signs of
// det[a, b, q], det[b, c, q] and det[c, a, q] say on which sides of the edges the direction q lies,
// wherever the corners are, in front of the light or behind it: nothing is ever clipped. For a
// directional light the edges are lines in the plane of u and v.
//
// Error bounds, with e = 2^-24, a rectangle R of directions, and `reach` the largest 1-norm of its
// points. The exact test (occlusion.glsl) sees corner r, relative to the point, off by at most
// 9 e |r| (one rounding of the difference, three of the shear and its coefficients, per axis), and
// the segment's direction off by 2 e: together 11 e |r|. Here a corner is off by 2 e |a|, q by 3 e.
// With S = |a| + reach >= |r|, every corner is thus off by less than 16 e S as seen from here.
//   Footprint. Corners off by D in front of the light, z > 2 D, project off by at most
//   (1 + |u|) D / (z - D) <= 2 (1 + |u|) D / z. The cone of a triangle lies beyond x = s z if all
//   corners are beyond it by (1 + |s|) D, and is empty if all z < -D.
//   Edge from a to b, n = a x (b - a): moving corner a by D changes n . q = det[a, b, q] by at most
//   |D| |b x q|, so both corners by 16 e (S_a X_b + S_b X_a), X being the largest |corner x q| over
//   R, at most the one at its centre plus the corner times the half diagonal. Evaluating n and n .
//   q adds 8 e |a| |b - a| |q|. For a directional light the same holds with X the distance across
//   between corner and q, and the edge instead of n.
//   Plane N = (b - a) x (c - a), where the exact test gives the answer of exact arithmetic: N is
//   off by 5 e |b - a| |c - a|, so w = N . a, the side of the light, by 13 e |b - a| |c - a| |a|,
//   and N . d - w, the side of the point, by 13 e |b - a| |c - a| (|a| + |d|).
// The factors below are at least twice these, and 1-norms stand for lengths. Each function is
// scaled so that its error is 1; where that would overflow it is 0, which is always in doubt.
#ifndef SHADOWS_IZB_CASTER_GLSL
#define SHADOWS_IZB_CASTER_GLSL
#include "shadows/izb/frame.glsl"

const float kError = 2.0 * 16.0 / 16777216.0;

struct Corners {
    vec3 a, b, c;     // in the frame
    vec3 ab, bc, ca;  // differences, each with a single rounding
};

struct Caster {
    vec3 ab, bc,
        ca;      // factors of u, v, 1; of one sign inside, the positive one in front of the light
    vec4 plane;  // factors of u, v, 1, k: positive for points it separates from the light.
    float certain;  // The last is that of the upper bound; this one of the lower.
};

struct Rectangle {
    vec2 lower, upper;
};

Corners corners_of(CornerTriangle t, vec3 origin, float scale, uint face) {
    return Corners(to_face((t.a - origin) * scale, face), to_face((t.b - origin) * scale, face),
                   to_face((t.c - origin) * scale, face), to_face((t.b - t.a) * scale, face),
                   to_face((t.c - t.b) * scale, face), to_face((t.a - t.c) * scale, face));
}

vec2 across(vec3 r, vec2 tilt) { return kDirectional ? r.xy - tilt * r.z : r.xy / r.z; }

// Narrows `r` to what the triangle may cover of it; false if that is nothing.
bool footprint(Corners t, vec2 tilt, float reach, inout Rectangle r) {
    const float slack = kError * (max(max(norm1(t.a), norm1(t.b)), norm1(t.c)) + reach);
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

float certainty(float error) { return error > 1e-37 && error < 1e37 ? 1.0 / error : 0.0; }

vec3 edge_function(vec3 r, vec3 edge, vec2 tilt) {
    if (!kDirectional) return cross(r, edge);
    const vec2 e = across(edge, tilt), from = across(r, tilt);
    return vec3(-e.y, e.x, e.y * from.x - e.x * from.y);
}

// X above: the largest distance across of a corner from directions in the rectangle.
float spread(vec3 r, vec2 tilt, vec2 centre, vec2 half_size) {
    if (kDirectional) {
        const vec2 q = abs(across(r, tilt) - centre) + half_size;
        return q.x + q.y;
    }
    return norm1(cross(r, vec3(centre, 1))) + norm1(r) * (half_size.x + half_size.y);
}

float edge_error(float s_a, float x_a, float s_b, float x_b, vec3 a, vec3 edge, float widest) {
    return kError * (s_a * x_b + s_b * x_a +
                     norm1(edge) * (kDirectional ? norm1(a) + widest : norm1(a) * widest));
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
        2.0 * kError * size * (kDirectional ? 1.0 + abs(tilt.x) + abs(tilt.y) : length_a);
    Caster caster;
    // The exact plane test tells front from back of a triangle for the light if this does.
    if (abs(facing) > facing_error) {
        const float side = facing < 0 ? -1.0 : 1.0;
        if (kDirectional) {
            const float scale = certainty(2.0 * kError * size * (length_a + reach));
            caster.plane = -side * scale * vec4(normal.xy, -w, facing);
            caster.certain = caster.plane.w;
        } else {
            const float scale = certainty(2.0 * kError * size * widest);
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
                certainty(edge_error(sa, xa, sb, xb, t.a, t.ab, widest));
    caster.bc = edge_function(t.b, t.bc, tilt) * inside *
                certainty(edge_error(sb, xb, sc, xc, t.b, t.bc, widest));
    caster.ca = edge_function(t.c, t.ca, tilt) * inside *
                certainty(edge_error(sc, xc, sa, xa, t.c, t.ca, widest));
    return caster;
}

// Least and largest value over a rectangle.
vec2 range_of(vec3 f, Rectangle r) {
    const vec2 a = f.xy * r.lower, b = f.xy * r.upper;
    const vec2 least = min(a, b), most = max(a, b);
    return vec2(least.x + least.y, most.x + most.y) + f.z;
}

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
