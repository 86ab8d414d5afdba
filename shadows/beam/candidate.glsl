// Triangles against a beam, then against its points: part of beam.glsl.
//
// A candidate is four linear functions of (u, v, k): one for each edge, positive inside, and one
// for the supporting plane, positive for points that it separates from the light. Each is scaled
// so that its error against the exact test (occlusion.glsl) is below 1: all four above 1 is a
// certain hit, one below -1 a certain miss, and what lies between goes to the exact test.
//
// Error bounds: those of edges are in edges.glsl, whose notation goes on here.
//   Footprint: corners' own roundings, those of the points' u and v, and a quotient move a corner
//   by at most 16 e S as seen from a point.
//   Plane N = (b - a) x (c - a): the computed N' is off by 5 e |b - a| |c - a|, and N' . d - w with
//   w = N' . a is off by that times |d - a|, plus 13 e |N'| (|a| + |d|) for the roundings of a, of
//   u, v and k, of w and of the sum. The light's side, N' . (tilt, 1) or w, is off by
//   13 e |b - a| |c - a| times |(tilt, 1)| or |a|.
// The factors below are at least twice these.
#ifndef SHADOWS_BEAM_CANDIDATE_GLSL
#define SHADOWS_BEAM_CANDIDATE_GLSL

struct Candidate {
    vec3 edge_ab, edge_bc, edge_ca;  // factors of u, v, 1
    vec4 plane;                      // factors of u, v, k, 1
    uint sections;                   // those with points that it may hit
    uint receiver;                   // its primitive if points of the tile may lie on it
};

const uint kMiss = 0u, kMeets = 1u, kCovers = 2u;
const float kPlaneError = 2.0 * 16.0 / 16777216.0;

vec3 from_world(vec3 p) { return to_beam((p - beam_origin) * beam_scale); }

vec2 range_of(vec3 f) { return range_of(f, beam.lower, beam.upper); }

// Rectangle of u and v that holds every point the triangle may occlude, corners off by the bound
// above; the whole plane if a corner is not in front of the light.
void footprint(vec3 a, vec3 b, vec3 c, out vec2 lower, out vec2 upper) {
    const vec3 ra = from_world(a), rb = from_world(b), rc = from_world(c);
    const float slack = kEdgeError * (max(max(norm1(ra), norm1(rb)), norm1(rc)) + beam.reach);
    const float nearest = min(min(ra.z, rb.z), rc.z);
    if (!kDirectional && !(nearest > 2.0 * slack)) {
        lower = vec2(-kHuge);
        upper = vec2(kHuge);
        return;
    }
    const vec2 qa = across(ra, beam.tilt), qb = across(rb, beam.tilt), qc = across(rc, beam.tilt);
    const vec2 margin =
        kDirectional ? slack * (1.0 + abs(beam.tilt))
                     : slack / nearest * 2.0 * (1.0 + max(max(abs(qa), abs(qb)), abs(qc)));
    lower = min(min(qa, qb), qc) - margin;
    upper = max(max(qa, qb), qc) + margin;
}

// What the triangle is to the whole beam: kMiss, kMeets, or kCovers if it certainly occludes all
// points.
uint classify(vec3 a, vec3 b, vec3 c, uint live, out Candidate candidate) {
    const vec3 ra = from_world(a), rb = from_world(b), rc = from_world(c);
    const vec3 ab = to_beam((b - a) * beam_scale), bc = to_beam((c - b) * beam_scale),
               ca = to_beam((a - c) * beam_scale);
    const float la = norm1(ra), lb = norm1(rb), lc = norm1(rc);
    const float sa = la + beam.reach, sb = lb + beam.reach, sc = lc + beam.reach;

    // All corners beyond one side of the beam.
    const vec2 widest_slope = max(abs(beam.slope_lower), abs(beam.slope_upper));
    const float slack =
        max(max(sa, sb), sc) * kEdgeError * (1.0 + max(widest_slope.x, widest_slope.y));
    const vec2 past_lower =
        max(max(ra.xy - beam.slope_lower * ra.z, rb.xy - beam.slope_lower * rb.z),
            rc.xy - beam.slope_lower * rc.z);
    const vec2 past_upper =
        min(min(ra.xy - beam.slope_upper * ra.z, rb.xy - beam.slope_upper * rb.z),
            rc.xy - beam.slope_upper * rc.z);
    const vec3 least = min(min(ra, rb), rc), most = max(max(ra, rb), rc);
    if (any(lessThan(past_lower + slack, beam.offset_lower)) ||
        any(greaterThan(past_upper - slack, beam.offset_upper)) ||
        any(lessThan(most + slack, beam.hull_lower)) ||
        any(greaterThan(least - slack, beam.hull_upper)))
        return kMiss;

    const vec3 normal = cross(ca, ab);
    const float size = norm1(ab) * norm1(ca);
    const float w = dot(normal, ra);
    // Light's side of the plane, and the error of that number.
    float facing, facing_error;
    vec4 plane;
    if (kDirectional) {
        facing = dot(normal, vec3(beam.tilt, 1));
        facing_error = kPlaneError * size * (1.0 + abs(beam.tilt.x) + abs(beam.tilt.y));
        plane = vec4(normal.xy, facing, -w);
    } else {
        facing = w;
        facing_error = kPlaneError * size * (la + beam.reach);
        plane = vec4(normal.xy, -w, normal.z);
    }
    const vec2 tilt = beam.tilt, centre = 0.5 * beam.lower + 0.5 * beam.upper;
    const vec2 half_size = 0.5 * (beam.upper - beam.lower);
    const vec2 outermost = max(abs(beam.lower), abs(beam.upper));
    const float widest = outermost.x + outermost.y + (kDirectional ? 0.0 : 1.0);
    const float xa = spread(ra, tilt, centre, half_size), xb = spread(rb, tilt, centre, half_size),
                xc = spread(rc, tilt, centre, half_size);
    const float inside = facing < 0 ? -1.0 : 1.0;
    candidate.edge_ab = edge_function(ra, ab, tilt) * inside;
    candidate.edge_bc = edge_function(rb, bc, tilt) * inside;
    candidate.edge_ca = edge_function(rc, ca, tilt) * inside;
    const vec3 error = vec3(edge_error(sa, xa, sb, xb, la, norm1(ab), widest),
                            edge_error(sb, xb, sc, xc, lb, norm1(bc), widest),
                            edge_error(sc, xc, sa, xa, lc, norm1(ca), widest));
    const float occluded_side = kDirectional ? -inside : inside;
    plane *= occluded_side;
    const float farthest = norm1(max(beam.points_upper - ra, ra - beam.points_lower));
    float plane_error = kPlaneError * (size * farthest + norm1(normal) * (la + beam.reach));

    const vec2 ab_range = range_of(candidate.edge_ab), bc_range = range_of(candidate.edge_bc),
               ca_range = range_of(candidate.edge_ca);
    const vec3 edge_least = vec3(ab_range.x, bc_range.x, ca_range.x);
    const vec3 edge_most = vec3(ab_range.y, bc_range.y, ca_range.y);
    bool covers = false;
    const bool certain_side = abs(facing) > facing_error;
    if (certain_side) {
        // The plane's function over the box of the points: normal . d - w, or in u, v, z.
        const vec3 slope = kDirectional ? plane.xyz : vec3(plane.xy, plane.w);
        const vec3 f = slope * beam.box_lower, g = slope * beam.box_upper;
        const float constant = kDirectional ? plane.w : plane.z;
        const vec3 low = min(f, g), high = max(f, g);
        const float plane_most = high.x + high.y + high.z + constant;
        const float plane_least = low.x + low.y + low.z + constant;
        if (any(lessThan(edge_most, -error)) || plane_most < -plane_error) return kMiss;
        covers = all(greaterThan(edge_least, error)) && plane_least > plane_error;
        vec2 lower, upper;
        footprint(a, b, c, lower, upper);
        candidate.sections = 0;
        [[unroll]] for (uint s = 0; s < kSections; ++s) {
            if (!(any(lessThan(upper, section_lower[s])) ||
                  any(greaterThan(lower, section_upper[s]))))
                candidate.sections |= 1u << (s * kSectionSlots);
        }
        candidate.sections &= live;
        if (candidate.sections == 0) return kMiss;
        if (!kDirectional) plane_error *= beam.key.y;
        plane *= certainty(plane_error);
    } else {
        // The light is as good as in the plane: nothing here tells front from back. Still a miss if
        // the whole beam is on different sides of two edges.
        if (any(lessThan(edge_most, -error)) && any(greaterThan(edge_least, error))) return kMiss;
        plane = vec4(0);
        candidate.sections = live;
        candidate.edge_ab = candidate.edge_bc = candidate.edge_ca = vec3(0);
    }
    candidate.edge_ab *= certainty(error.x);
    candidate.edge_bc *= certainty(error.y);
    candidate.edge_ca *= certainty(error.z);
    candidate.plane = plane;
    return covers ? kCovers : kMeets;
}

Candidate broadcast(Candidate candidate, uint from) {
    candidate.edge_ab = subgroupShuffle(candidate.edge_ab, from);
    candidate.edge_bc = subgroupShuffle(candidate.edge_bc, from);
    candidate.edge_ca = subgroupShuffle(candidate.edge_ca, from);
    candidate.plane = subgroupShuffle(candidate.plane, from);
    candidate.sections = subgroupShuffle(candidate.sections, from);
    candidate.receiver = subgroupShuffle(candidate.receiver, from);
    return candidate;
}

// Slots that the candidate certainly hits, and those where it may. A primitive hits none of its own
// points, however far rounding has moved them off it.
void test_points(Candidate c, out uint hit, out uint doubtful) {
    hit = 0;
    doubtful = 0;
    uint own = 0;
    [[unroll]] for (uint s = 0; s < kSections; ++s) {
        if (!has_bit(c.sections, s * kSectionSlots)) continue;
        [[unroll]] for (uint i = 0; i < kSectionSlots; ++i) {
            const uint k = s * kSectionSlots + i;
            const float u = point_u[k], v = point_v[k];
            const float ab = c.edge_ab.x * u + (c.edge_ab.y * v + c.edge_ab.z);
            const float bc = c.edge_bc.x * u + (c.edge_bc.y * v + c.edge_bc.z);
            const float ca = c.edge_ca.x * u + (c.edge_ca.y * v + c.edge_ca.z);
            const float side =
                c.plane.x * u + (c.plane.y * v + (c.plane.z * point_k[k] + c.plane.w));
            const float least = min(min(ab, bc), min(ca, side));
            hit |= least > 1.0 ? 1u << k : 0u;
            doubtful |= least < -1.0 ? 0u : 1u << k;
            own |= point_primitive[k] == c.receiver ? 1u << k : 0u;
        }
    }
    hit &= ~own;
    doubtful &= ~(hit | own);
}

#endif
