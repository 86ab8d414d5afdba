// Groups of points that share a beam: part of beam.glsl.
//
// Frame. Everything is taken relative to `beam_origin`: the light, or for a directional light a
// point of the scene. Axes are permuted so that the beam runs along z (and mirrored, so that z > 0
// for the points of a point light, and z grows towards a directional light). Coordinates across:
//   point light        u = x / z,          v = y / z,          depth key k = 1 / z
//   directional light  u = x - z tx / tz,  v = y - z ty / tz,  depth key k = z
// where t points towards the light. Either way a segment to the light keeps its u and v, and
// occluders of a point have the larger k. A plane is a linear function of u, v, k. Lengths are
// scaled by `beam_scale`, a power of two, to the order of 1: products of three neither overflow nor
// vanish, whatever the scene's unit.
#ifndef SHADOWS_BEAM_GROUP_GLSL
#define SHADOWS_BEAM_GROUP_GLSL

vec3 point_d[kSlots];   // relative to beam_origin, scaled, axes as in the world
float point_u[kSlots], point_v[kSlots], point_k[kSlots];
uint point_primitive[kSlots];

vec3 beam_origin;
float beam_scale;

// The power of two that takes `size` to between 1 and 2.
float scale_for(float size) {
    const uint exponent = clamp(floatBitsToUint(size) >> 23 & 0xffu, 1u, 253u);
    return uintBitsToFloat((254u - exponent) << 23);
}

// The tile's points in runs of 32 or more, each with its own rectangle of u and v: small triangles
// are tested against the runs that they can meet.
const uint kSections = kSlots < 8 ? kSlots : 8;
const uint kSectionSlots = kSlots / kSections;

// Sections with some of `slots` in any lane: the bit of a section is that of its first slot.
uint live_sections(uint slots) {
    uint first = 0;
    [[unroll]] for (uint s = 0; s < kSections; ++s) first |= 1u << (s * kSectionSlots);
    [[unroll]] for (uint k = 0; k < 5; ++k)
        if (1u << k < kSectionSlots) slots |= slots >> (1u << k);
    return subgroupOr(slots & first);
}
vec2 section_lower[kSections], section_upper[kSections];

struct Beam {
    int axis;          // of the world that is z here
    float mirror;      // 1 or -1: factor of that axis
    vec2 tilt;         // directional: t.xy / t.z
    vec2 lower, upper; // the rectangle of u and v
    vec2 key;          // smallest and largest k
    vec3 points_lower, points_upper;  // box of the points: x, y, z
    vec3 box_lower, box_upper;    // the same (point light), or in u, v, z (directional)
    vec3 hull_lower, hull_upper;  // box of all segments, x, y, z
    // Side planes: inside where x - slope z >= offset (lower) and <= offset (upper), same for y.
    vec2 slope_lower, slope_upper, offset_lower, offset_upper;
    float reach;       // largest |d|_1 of a point
};
Beam beam;

// From the world's axes to the beam's.
vec3 to_beam(vec3 v) {
    vec3 permuted = beam.axis == 0 ? v.yzx : beam.axis == 1 ? v.zxy : v;
    permuted.z *= beam.mirror;
    return permuted;
}

vec3 from_beam(vec3 v) {
    v.z *= beam.mirror;
    return beam.axis == 0 ? v.zxy : beam.axis == 1 ? v.yzx : v;
}

// Points whose distance to the light is below this are left to the per-point walk: 1 / z overflows.
const float kTinyDistance = 1e-30;
// An axis is good for all points of a group if none is further off it than this factor.
const float kWidestSlope = 4.0;
// A group splits at an empty interval of this share of its extent.
const float kGapShare = 0.3;

void bounds_of(uint bits, out vec3 lower, out vec3 upper) {
    lower = vec3(kHuge);
    upper = vec3(-kHuge);
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const bool in_group = has_bit(bits, k);
        lower = min(lower, in_group ? point_d[k] : vec3(kHuge));
        upper = max(upper, in_group ? point_d[k] : vec3(-kHuge));
    }
    lower = reduce_min(lower);
    upper = reduce_max(upper);
}

// The axis and side on which the points lie furthest from the light's own plane. If none keeps
// them all in a moderate slope, the axis and side of the single farthest coordinate, and of the
// points only those that are within the slope: the others come back in another group.
uint choose_axis(uint bits, vec3 lower, vec3 upper) {
    const vec3 nearest = max(lower, -upper);
    const vec3 farthest = max(upper, -lower);
    beam.axis = nearest.x > nearest.y ? (nearest.x > nearest.z ? 0 : 2)
                                      : (nearest.y > nearest.z ? 1 : 2);
    const float widest = max(max(farthest.x, farthest.y), farthest.z);
    bool all_fit = nearest[beam.axis] * kWidestSlope >= widest;
    if (!all_fit)
        beam.axis = farthest.x > farthest.y ? (farthest.x > farthest.z ? 0 : 2)
                                            : (farthest.y > farthest.z ? 1 : 2);
    beam.mirror = all_fit ? (lower[beam.axis] > 0 ? 1.0 : -1.0)
                          : (upper[beam.axis] >= -lower[beam.axis] ? 1.0 : -1.0);
    if (all_fit) return bits;
    uint kept = 0;
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const vec3 d = to_beam(point_d[k]);
        if (d.z > 0 && d.z * kWidestSlope * 0.5 >= max(abs(d.x), abs(d.y))) kept |= 1u << k;
    }
    return kept & bits;
}

void project() {
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const vec3 d = to_beam(point_d[k]);
        if (kDirectional) {
            point_u[k] = d.x - d.z * beam.tilt.x;
            point_v[k] = d.y - d.z * beam.tilt.y;
            point_k[k] = d.z;
        } else {
            point_k[k] = 1.0 / d.z;
            point_u[k] = d.x * point_k[k];
            point_v[k] = d.y * point_k[k];
        }
    }
}

void rectangle_of(uint bits) {
    vec2 lower = vec2(kHuge), upper = vec2(-kHuge);
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const vec2 q = vec2(point_u[k], point_v[k]);
        const bool in_group = has_bit(bits, k);
        lower = min(lower, in_group ? q : vec2(kHuge));
        upper = max(upper, in_group ? q : vec2(-kHuge));
    }
    beam.lower = reduce_min(lower);
    beam.upper = reduce_max(upper);
}

// Rectangles of the sections, widened like the beam's own; that of a section without points of the
// group is empty.
void rectangles_of_sections(uint bits, vec2 slack) {
    [[unroll]] for (uint s = 0; s < kSections; ++s) {
        vec2 lower = vec2(kHuge), upper = vec2(-kHuge);
        [[unroll]] for (uint i = 0; i < kSectionSlots; ++i) {
            const uint k = s * kSectionSlots + i;
            const vec2 q = vec2(point_u[k], point_v[k]);
            const bool in_group = has_bit(bits, k);
            lower = min(lower, in_group ? q : vec2(kHuge));
            upper = max(upper, in_group ? q : vec2(-kHuge));
        }
        section_lower[s] = reduce_min(lower) - slack;
        section_upper[s] = reduce_max(upper) + slack;
    }
}

// Cuts the group where its directions leave the widest gap around the middle, if it is wide:
// depth edges otherwise make one fat beam of two thin ones. Keeps the lower side.
uint split_at_gap(uint bits) {
    rectangle_of(bits);
    const vec2 middle = 0.5 * beam.lower + 0.5 * beam.upper;
    vec2 below = beam.lower, above = beam.upper;
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const vec2 q = vec2(point_u[k], point_v[k]);
        const bool in_group = has_bit(bits, k);
        below = max(below, mix(beam.lower, q, bvec2(in_group && q.x < middle.x,
                                                    in_group && q.y < middle.y)));
        above = min(above, mix(beam.upper, q, bvec2(in_group && q.x >= middle.x,
                                                    in_group && q.y >= middle.y)));
    }
    below = reduce_max(below);
    above = reduce_min(above);
    const vec2 gap = above - below, extent = beam.upper - beam.lower;
    const bool by_u = gap.x * extent.y >= gap.y * extent.x;
    if (by_u ? gap.x > kGapShare * extent.x : gap.y > kGapShare * extent.y) {
        uint kept = 0;
        [[unroll]] for (uint k = 0; k < kSlots; ++k)
            if (by_u ? point_u[k] < middle.x : point_v[k] < middle.y) kept |= 1u << k;
        bits &= kept;
        rectangle_of(bits);
    }
    return bits;
}

// Takes the next group out of `todo` (not 0 in some lane) and sets up its beam.
uint take_group(uint todo, vec3 towards_light) {
    uint bits = todo;
    vec3 lower, upper;
    bounds_of(bits, lower, upper);
    if (kDirectional) {
        const vec3 size = abs(towards_light);
        beam.axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        beam.mirror = towards_light[beam.axis] > 0 ? 1.0 : -1.0;
        const vec3 t = to_beam(towards_light);
        beam.tilt = t.xy / t.z;
    } else {
        bits = choose_axis(bits, lower, upper);
    }
    project();
    bits = split_at_gap(bits);
    if (subgroupAny(bits != todo)) bounds_of(bits, lower, upper);
    const vec3 farthest = max(abs(lower), abs(upper));
    beam.reach = farthest.x + farthest.y + farthest.z;
    const vec3 p = to_beam(lower), q = to_beam(upper);
    const vec3 box_lower = min(p, q), box_upper = max(p, q);
    beam.points_lower = box_lower;
    beam.points_upper = box_upper;
    // Rounding of u and v, and of the segment's own direction (2^-20 = 16 roundings).
    const float kRound = 9.5367431640625e-7;
    if (kDirectional) {
        const vec2 slack = vec2(beam.reach * kRound);
        beam.lower -= slack;
        beam.upper += slack;
        rectangles_of_sections(bits, slack);
        beam.key = vec2(box_lower.z, box_upper.z);
        beam.box_lower = vec3(beam.lower, box_lower.z);
        beam.box_upper = vec3(beam.upper, box_upper.z);
        beam.hull_lower =
            vec3(mix(vec2(-kHuge), box_lower.xy, greaterThanEqual(beam.tilt, vec2(0))),
                 box_lower.z);
        beam.hull_upper =
            vec3(mix(vec2(kHuge), box_upper.xy, lessThanEqual(beam.tilt, vec2(0))), kHuge);
        beam.slope_lower = beam.slope_upper = beam.tilt;
        beam.offset_lower = beam.lower;
        beam.offset_upper = beam.upper;
    } else {
        const vec2 slack = max(max(abs(beam.lower), abs(beam.upper)), vec2(1)) * kRound;
        beam.lower -= slack;
        beam.upper += slack;
        rectangles_of_sections(bits, slack);
        beam.key = vec2(1.0 / box_upper.z, 1.0 / box_lower.z);
        beam.box_lower = box_lower;
        beam.box_upper = box_upper;
        beam.hull_lower = vec3(min(box_lower.xy, vec2(0)), 0);
        beam.hull_upper = vec3(max(box_upper.xy, vec2(0)), box_upper.z);
        beam.slope_lower = beam.lower;
        beam.slope_upper = beam.upper;
        beam.offset_lower = beam.offset_upper = vec2(0);
    }
    return bits;
}

// Whether a box (beam frame, already widened by its own rounding) may meet a segment of the group.
bool beam_meets_box(vec3 lower, vec3 upper) {
    // max over the box of x - slope z is at upper x and the end of z that the slope's sign says.
    const vec2 inside_lower =
        upper.xy - min(beam.slope_lower * lower.z, beam.slope_lower * upper.z);
    const vec2 inside_upper =
        lower.xy - max(beam.slope_upper * lower.z, beam.slope_upper * upper.z);
    return !(any(lessThan(inside_lower, beam.offset_lower)) ||
             any(greaterThan(inside_upper, beam.offset_upper)) ||
             any(lessThan(upper, beam.hull_lower)) || any(greaterThan(lower, beam.hull_upper)));
}

#endif
