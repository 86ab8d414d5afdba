// What the leaves of single segments ask: the exact test, or one of the shortcuts that others take,
// to see what they cost in correctness. Only the exact test counts as an answer.
//
//     int hit = leaf_occludes(segment, a, b, c);   // 1, 0, or kUnsure: left to occludes_exactly()
//
// The shortcuts decide as their authors wrote them down, in plain floating point.
#ifndef SHADOWS_BVH_LEAF_VARIANTS_GLSL
#define SHADOWS_BVH_LEAF_VARIANTS_GLSL
#include "shadows/occlusion.glsl"
#include "shadows/bvh/leaf_shared.h"

layout(constant_id = 20) const uint kLeaf = kLeafExact;
layout(constant_id = 21) const bool kContraction = false;  // of the watertight test's edges

// x y - z w; contracted as a compiler may, with the first product unrounded. Spelled out in double
// precision, since fma() need not be fused.
float difference_of_products(float x, float y, float z, float w) {
    precise float second = z * w;
    precise float plain = x * y - second;
    precise float fused = float(double(x) * double(y) - double(second));
    return kContraction ? fused : plain;
}

// Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", without its second look in
// double precision at edge functions that are 0.
bool occludes_watertight(Segment s, vec3 a, vec3 b, vec3 c) {
    const vec3 ra = seen_from_origin(s, a), rb = seen_from_origin(s, b), rc = seen_from_origin(s, c);
    const vec2 sa = sheared(s, ra), sb = sheared(s, rb), sc = sheared(s, rc);
    const float u = difference_of_products(sc.x, sb.y, sc.y, sb.x);
    const float v = difference_of_products(sa.x, sc.y, sa.y, sc.x);
    const float w = difference_of_products(sb.x, sa.y, sb.y, sa.x);
    if (min(min(u, v), w) < 0 && max(max(u, v), w) > 0) return false;
    precise float sum = u + v + w;
    precise float depth = (u * ra.z + v * rb.z + w * rc.z) * s.shear.z;
    const float scaled = sum < 0 ? -depth : depth;
    return sum != 0 && scaled > 0 && (s.directional || scaled < abs(sum));
}

// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
bool occludes_moeller_trumbore(Segment s, vec3 a, vec3 b, vec3 c) {
    precise vec3 direction = s.directional ? s.target : s.target - s.origin;
    precise vec3 ab = b - a, ac = c - a, from_a = s.origin - a;
    precise vec3 pv = cross(direction, ac), qv = cross(from_a, ab);
    precise float det = dot(ab, pv);
    if (det == 0) return false;
    precise float inverse = 1.0 / det;
    precise float u = dot(from_a, pv) * inverse, v = dot(direction, qv) * inverse;
    precise float sum = u + v, t = dot(ac, qv) * inverse;
    return u >= 0 && v >= 0 && sum <= 1 && t > 0 && (s.directional || t < 1);
}

// The signs of exact_occlusion.glsl as double precision has them, right or wrong.
double side_as_computed(dvec3 q, dvec3 y, dvec3 z) {
    precise dvec3 normal = cross(y, z);
    precise double side = dot(q, normal);
    return side;
}

bool occludes_plain_double(Segment s, vec3 a, vec3 b, vec3 c) {
    const dvec3 p = dvec3(s.origin), ra = dvec3(a) - p, rb = dvec3(b) - p, rc = dvec3(c) - p;
    const dvec3 towards = s.directional ? dvec3(s.target) : dvec3(s.target) - p;
    const double ab = side_as_computed(towards, rb, ra), bc = side_as_computed(towards, rc, rb),
                 ca = side_as_computed(towards, ra, rc);
    if (min(min(ab, bc), ca) < 0.0LF && max(max(ab, bc), ca) > 0.0LF) return false;
    const double here = side_as_computed(-ra, rb - ra, rc - ra);
    const double there = side_as_computed(s.directional ? towards : towards - ra, rb - ra, rc - ra);
    return (here < 0.0LF && there > 0.0LF) || (here > 0.0LF && there < 0.0LF);
}

int leaf_occludes(Segment s, vec3 a, vec3 b, vec3 c) {
    if (kLeaf == kLeafWatertight) return int(occludes_watertight(s, a, b, c));
    if (kLeaf == kLeafMoellerTrumbore) return int(occludes_moeller_trumbore(s, a, b, c));
    if (kLeaf == kLeafDouble) return int(occludes_plain_double(s, a, b, c));
    return occludes_quickly(s, a, b, c);
}

#endif
