// A triangle's edges as linear functions of where a point lies as seen from the light, with bounds
// of their errors: what beams (candidate.glsl) and the irregular z-buffer (izb/caster.glsl) share.
//
// Homogeneous rasterisation (M. Olano and T. Greer, "Triangle scan conversion using 2D homogeneous
// coordinates", 1997): with corners a, b, c relative to the light and q = (u, v, 1), the signs of
// det[a, b, q], det[b, c, q] and det[c, a, q] say on which sides of the edges the direction q lies,
// wherever the corners are, in front of the light or behind it: nothing is ever clipped. For a
// directional light the edges are lines in the plane of u and v.
//
// Both use frames in which a point d relative to the light, or to a point of the scene, has
//   point light        u = x / z,             v = y / z
//   directional light  u = x - z t.x / t.z,   v = y - z t.y / t.z,   |t.x|, |t.y| <= |t.z|
// where t points towards the light; t.xy / t.z is the tilt. See group.glsl and izb/frame.glsl.
//
// Error bounds. The exact test (occlusion.glsl) gives the answer of exact arithmetic, so all errors
// are made here. Lengths are 1-norms; e = 2^-24; sums, differences and products are off by e,
// quotients by 5 e (Vulkan), relatively; a sum of n terms counts as n - 1 roundings of all of them.
// `reach` is the largest length of a point, R the rectangle of the points' u and v, and S = |a| +
// reach.
//   Corners and edges, taken from the world, are off by e |a| and e |b - a|. A point light's u and
//   v are off by 8 e |u|, 8 e |v|: two differences, a quotient, a product.
//   Point light: n = a x (b - a), and the function is n . q. In units of e |a| |b - a| |q|, it is
//   off by 1 for a, 1 for b - a, 2 for n, 8 for q, 3 for n . q, 1 for the scale: 16 in all.
//   Directional light: the edge E = across(b - a) and the corner A = across(a) in the plane of u
//   and v; the function is E x ((u, v) - A). The tilt, off by 5 e, moves a corner, as seen from the
//   point, by 5 e S; u and v by their own roundings by 3 e reach more. Moving corners a and b by
//   8 e S each changes the function by at most 8 e (S_a X_b + S_b X_a), X being the largest
//   |corner - q| over R, at most that at its centre plus the half diagonal. The roundings of A add
//   6 e |b - a| |a|, those of E 3 e |b - a| (|q| + 2 |a|), products and sums 3 e |b - a| |q| and
//   8 e |b - a| |a|, the scale e |b - a| (|q| + 2 |a|): together 7 e |b - a| |q| and
//   22 e |b - a| |a|.
// kEdgeError is 32 e, for both sums. The term with X is there for a point light, too, where X is
// the largest |corner x q|; it makes up for corners that are off by 16 e S as seen from the point.
#ifndef SHADOWS_BEAM_EDGES_GLSL
#define SHADOWS_BEAM_EDGES_GLSL
#include "shadows/beam/points.glsl"

const float kHuge = 3.0e38;
const float kEdgeError = 2.0 * 16.0 / 16777216.0;

// u and v of a corner.
vec2 across(vec3 r, vec2 tilt) { return kDirectional ? r.xy - tilt * r.z : r.xy / r.z; }

// Factors of u, v and 1, before scaling, of the edge that starts at r.
vec3 edge_function(vec3 r, vec3 edge, vec2 tilt) {
    if (!kDirectional) return cross(r, edge);
    const vec2 e = across(edge, tilt), from = across(r, tilt);
    return vec3(-e.y, e.x, e.y * from.x - e.x * from.y);
}

// X above, of a corner and the rectangle around `centre`.
float spread(vec3 r, vec2 tilt, vec2 centre, vec2 half_size) {
    if (kDirectional) {
        const vec2 q = abs(across(r, tilt) - centre) + half_size;
        return q.x + q.y;
    }
    return norm1(cross(r, vec3(centre, 1))) + norm1(r) * (half_size.x + half_size.y);
}

// Bound of the error of an edge's function, from S and X of its ends, the lengths of its first
// corner and of itself, and the largest |q|.
float edge_error(float s_a, float x_a, float s_b, float x_b, float length_a, float length_edge,
                 float widest) {
    return kEdgeError * (s_a * x_b + s_b * x_a +
                         length_edge * (kDirectional ? length_a + widest : length_a * widest));
}

// What scales a function to an error of 1; 0, which makes every point doubtful, if the bound is 0
// or not finite.
float certainty(float error) { return error > 1e-37 && error < 1e37 ? 1.0 / error : 0.0; }

// Least and largest value of a function over a rectangle.
vec2 range_of(vec3 f, vec2 lower, vec2 upper) {
    const vec2 a = f.xy * lower, b = f.xy * upper;
    const vec2 least = min(a, b), most = max(a, b);
    return vec2(least.x + least.y, most.x + most.y) + f.z;
}

#endif
