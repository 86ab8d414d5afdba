// Does a triangle block the segment from a receiver to the light? The last word of every
// structure's shadow query, so that all of them answer bit for bit alike.
//
//     Segment s = point_segment(p, light);             // or directional_segment(p, towards_light)
//     if (primitive != own && occludes(s, a, b, c)) ...
//
// A hit is a proper crossing of the closed triangle, from either side, strictly between receiver
// and light. A segment in the triangle's plane hits nothing; neither does one that ends on it.
//
// Edges: Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection". Relative to p, with
// the light's dominant axis as z, corners are sheared onto z's axis; the three edge functions are
// differences of two products of the same rounded corners, so neighbours see the same edge with
// opposite sign. Rounding is monotone: such a difference never has the wrong sign, at worst a false
// 0, and then products and signs are taken again in double precision, where products of single
// precision values are exact. An edge belongs to both of its triangles. None of this survives
// contraction into fused operations, hence `precise`.
//
// Depth: whether the plane of the triangle separates p and the light. In single precision from the
// edge functions when that clears its error bound, else from the corners in double precision.
#ifndef SHADOWS_OCCLUSION_GLSL
#define SHADOWS_OCCLUSION_GLSL

struct Segment {
    vec3 origin;    // the receiver
    vec3 target;    // the light, or, if `directional`, the direction towards it
    vec3 shear;     // x and y per z, and 1 / z, of origin -> light in the order of the axes below
    int axis;       // dominant axis: 0, 1, 2
    bool directional;
};

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
    precise vec3 shear = vec3(d.x / d.z, d.y / d.z, 1.0 / d.z);
    s.shear = shear;
    return s;
}

Segment point_segment(vec3 p, vec3 light) {
    precise vec3 towards = light - p;
    return make_segment(p, light, towards, false);
}

Segment directional_segment(vec3 p, vec3 towards) { return make_segment(p, towards, towards, true); }

// Sign of the side of the triangle's plane on which `offset` from corner a lies, in fp64.
double plane_side(dvec3 normal, dvec3 offset) { return dot(normal, offset); }

bool separates_exact(Segment s, vec3 a, vec3 b, vec3 c) {
    const dvec3 corner = dvec3(a);
    const dvec3 normal = cross(dvec3(b) - corner, dvec3(c) - corner);
    const double here = plane_side(normal, dvec3(s.origin) - corner);
    const double there =
        plane_side(normal, s.directional ? dvec3(s.target) : dvec3(s.target) - corner);
    return (here < 0.0LF && there > 0.0LF) || (here > 0.0LF && there < 0.0LF);
}

bool occludes(Segment s, vec3 a, vec3 b, vec3 c) {
    precise vec3 ra = axis_last(a - s.origin, s.axis);
    precise vec3 rb = axis_last(b - s.origin, s.axis);
    precise vec3 rc = axis_last(c - s.origin, s.axis);
    precise vec2 sa = ra.xy - s.shear.xy * ra.z;
    precise vec2 sb = rb.xy - s.shear.xy * rb.z;
    precise vec2 sc = rc.xy - s.shear.xy * rc.z;
    precise float u = sc.x * sb.y - sc.y * sb.x;
    precise float v = sa.x * sc.y - sa.y * sc.x;
    precise float w = sb.x * sa.y - sb.y * sa.x;
    bool below = u < 0 || v < 0 || w < 0, above = u > 0 || v > 0 || w > 0;
    if (below && above) return false;
    if (!(abs(u) > 0 && abs(v) > 0 && abs(w) > 0)) {
        const dvec2 da = dvec2(sa), db = dvec2(sb), dc = dvec2(sc);
        precise double du = dc.x * db.y - dc.y * db.x;
        precise double dv = da.x * dc.y - da.y * dc.x;
        precise double dw = db.x * da.y - db.y * da.x;
        below = du < 0.0LF || dv < 0.0LF || dw < 0.0LF;
        above = du > 0.0LF || dv > 0.0LF || dw > 0.0LF;
        if (below == above) return false;  // outside, or the triangle is seen edge-on
        return separates_exact(s, a, b, c);
    }
    // With barycentric weights u, v, w over their sum, the crossing lies at depth t of the way.
    // Error: a sheared corner is off by at most 9 * 2^-24 |corner|, which moves a weight by that
    // times the other corners' reach, 2 (reach.x + reach.y) at most, for each of two corners; the
    // remaining roundings are smaller. Three weights times the farthest depth: 2^-17 covers all.
    precise float sum = u + v + w;
    precise float depth = (u * ra.z + v * rb.z + w * rc.z) * s.shear.z;
    const vec2 reach = max(max(abs(sa), abs(sb)), abs(sc));
    const float farthest = max(max(abs(ra.z), abs(rb.z)), abs(rc.z)) * abs(s.shear.z);
    const vec3 size = max(max(abs(ra), abs(rb)), abs(rc));
    const float bound = (reach.x + reach.y) * max(max(size.x, size.y), size.z) * (farthest + 1.0) *
                        7.62939453125e-6;
    const float scaled = sum < 0 ? -depth : depth;
    const float total = abs(sum);
    if (scaled > bound && (s.directional || total - scaled > bound)) return true;
    if (scaled < -bound || (!s.directional && total - scaled < -bound)) return false;
    return separates_exact(s, a, b, c);
}

#endif
