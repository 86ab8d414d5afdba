// The volumes of clusters, one lane each: volume.cpp in single precision.
//
// Ball and capsule need not be the smallest, so only what is measured at the end has to bear its
// errors, with e = 2^-24:
// - the distance of a corner to the rounded axis errs by less than 8 e of the corner's distance to
//   an end and the axis' length; 16 e of the largest are added, and 4 e of the largest coordinate
//   as on the CPU;
// - its place along the slab's axis, by less than 6 e of its largest coordinate; 16 e are added;
// - the normal of edges u and v, by less than 10 e |u| |v|, and its cosine with the axis by that
// over
//   its length and 8 e; 32 e |u| |v| over its length are taken off, which is 32 e at least.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "structures/metric_tree/metric_tree_shared.h"
#include "taskpool/gpu/device.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 16) const bool kCapsules = true;

scalar_buffer(16) writeonly Clusters { Cluster at[]; };

layout(push_constant, scalar) uniform Push {
    Vec3Array positions;
    Uvec3Array triangles;
    UintArray order;
    UintArray firsts;  // where in the order clusters begin
    UintArray marks;   // there: how many triangles they have
    Clusters clusters;
    uint count;
}
push;

const float kInfinity = 1.0 / 0.0;
const float kError = 1.0 / 16777216.0;
const float kLongish = 2;  // as in volume.cpp
const uint kSweeps = 5;    // of Jacobi's rotations
const uint kSteps = 24;    // towards a smallest ball's centre

/// A cluster's triangles; coordinates are relative to one of its corners and scaled to about 1.
struct Source {
    uint first, count;
    vec3 origin;
    float scale;  // a power of two
};

vec3 corner_of(Source source, uint corner) {
    const uvec3 corners = push.triangles.at[push.order.at[source.first + corner / 3]];
    return push.positions.at[corners[corner % 3]];
}
vec3 place_of(Source source, uint corner) {
    return (corner_of(source, corner) - source.origin) * source.scale;
}

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

Source open_source(uint first, uint count) {
    Source source = Source(first, count, vec3(0), 1.0);
    source.origin = corner_of(source, 0);
    float size = 0;
    for (uint c = 1; c < 3 * count; ++c) size = max(size, largest(place_of(source, c)));
    const uint exponent = clamp(floatBitsToUint(size) >> 23, 1u, 252u);
    source.scale = uintBitsToFloat((253 - exponent) << 23);
    return source;
}

/// Turns rows and columns p and q so that what they share becomes 0.
void rotate(inout mat3 matrix, inout mat3 axes, uint p, uint q) {
    const float shared_part = matrix[p][q];
    if (abs(shared_part) < 1e-8 * (matrix[0][0] + matrix[1][1] + matrix[2][2])) return;
    const float theta = (matrix[q][q] - matrix[p][p]) / (2 * shared_part);
    const float tangent = (theta < 0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1));
    const float cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;
    mat3 turn = mat3(1);
    turn[p][p] = cosine;
    turn[q][q] = cosine;
    turn[q][p] = sine;
    turn[p][q] = -sine;
    matrix = transpose(turn) * matrix * turn;
    axes = axes * turn;
}

/// Principal axes of the corners, the longest first.
mat3 principal_axes(Source source) {
    vec3 mean = vec3(0);
    for (uint c = 0; c < 3 * source.count; ++c) mean += place_of(source, c);
    mean /= float(3 * source.count);
    mat3 covariance = mat3(0);
    for (uint c = 0; c < 3 * source.count; ++c) {
        const vec3 away = place_of(source, c) - mean;
        covariance += outerProduct(away, away);
    }
    mat3 axes = mat3(1);
    for (uint sweep = 0; sweep < kSweeps; ++sweep) {
        rotate(covariance, axes, 0, 1);
        rotate(covariance, axes, 0, 2);
        rotate(covariance, axes, 1, 2);
    }
    const vec3 spread = vec3(covariance[0][0], covariance[1][1], covariance[2][2]);
    const uint longest = spread.x >= spread.y && spread.x >= spread.z ? 0
                         : spread.y >= spread.z                       ? 1
                                                                      : 2;
    const uint next = (longest + 1) % 3, last = (longest + 2) % 3;
    const bool swapped = spread[next] < spread[last];
    const vec3 thinnest = normalize(axes[swapped ? next : last]);
    const vec3 along = normalize(axes[longest] - dot(axes[longest], thinnest) * thinnest);
    return mat3(along, cross(thinnest, along), thinnest);
}

vec3 extents_of(Source source, mat3 axes) {
    vec3 low = vec3(kInfinity), high = vec3(-kInfinity);
    for (uint c = 0; c < 3 * source.count; ++c) {
        const vec3 place = place_of(source, c) * axes;
        low = min(low, place);
        high = max(high, place);
    }
    return high - low;
}

/// Nearly the centre of the smallest ball around the corners after `project`, and its radius: the
/// best of steps to the farthest corner that become ever shorter (M. Badoiu and K. Clarkson, 2003).
vec3 smallest_center(Source source, mat3 project, out float radius) {
    vec3 low = vec3(kInfinity), high = vec3(-kInfinity);
    for (uint c = 0; c < 3 * source.count; ++c) {
        const vec3 place = project * place_of(source, c);
        low = min(low, place);
        high = max(high, place);
    }
    vec3 center = 0.5 * (low + high), best = center;
    float least = kInfinity;
    for (uint s = 0; s < kSteps; ++s) {
        float square = -1;
        vec3 farthest = center;
        for (uint c = 0; c < 3 * source.count; ++c) {
            const vec3 place = project * place_of(source, c), away = place - center;
            if (dot(away, away) <= square) continue;
            square = dot(away, away);
            farthest = place;
        }
        if (square < least) {
            least = square;
            best = center;
        }
        center += (farthest - center) / float(s + 5);
    }
    radius = sqrt(least);
    return best;
}

/// Ends of the axis of a capsule along the first of `axes`: as far in as all corners allow, see
/// volume.cpp. They meet if it is a ball.
void capsule_ends(Source source, mat3 axes, out vec3 a, out vec3 b) {
    const mat3 project = transpose(mat3(axes[1], axes[2], vec3(0)));
    float radius;
    const vec3 disc = smallest_center(source, project, radius);
    float begin = kInfinity, end = -kInfinity;
    for (uint c = 0; c < 3 * source.count; ++c) {
        const vec3 place = place_of(source, c), away = project * place - disc;
        const float spare = sqrt(max(radius * radius - dot(away, away), 0.0));
        const float along = dot(axes[0], place);
        begin = min(begin, along + spare);
        end = max(end, along - spare);
    }
    const float middle = 0.5 * (begin + end);
    const vec3 through = disc.x * axes[1] + disc.y * axes[2];
    a = through + min(begin, middle) * axes[0];
    b = through + max(end, middle) * axes[0];
}

/// From 0 to the segment from `a` along `e`.
float distance_to_axis(vec3 a, vec3 e) {
    const float ee = dot(e, e);
    const float t = ee > 0 ? clamp(-dot(a, e) / ee, 0.0, 1.0) : 0.0;
    return length(a + t * e);
}

void fit_volume(Source source, inout Cluster cluster) {
    const vec3 e = (cluster.b - cluster.a) * source.scale;
    float reach = 0, away = 0, low = kInfinity, high = -kInfinity;
    float coordinate = max(largest(cluster.a), largest(cluster.b));
    for (uint c = 0; c < 3 * source.count; ++c) {
        const vec3 corner = corner_of(source, c);
        const vec3 a = (cluster.a - corner) * source.scale;
        reach = max(reach, distance_to_axis(a, e));
        away = max(away, length(a));
        const float along = dot(cluster.axis, corner);
        low = min(low, along);
        high = max(high, along);
        coordinate = max(coordinate, largest(corner));
    }
    const float radius = (reach + 16 * kError * (away + length(e))) / source.scale;
    cluster.radius = radius + 4 * kError * (coordinate + radius);
    cluster.slab_low = low - 16 * kError * coordinate;
    cluster.slab_high = high + 16 * kError * coordinate;
}

/// Unit normal, and 32 e over the sine of the corner it was computed from; 0 and infinite if single
/// precision finds none.
vec3 normal_of(Source source, uint triangle, out float error) {
    const vec3 a = corner_of(source, 3 * triangle);
    const vec3 u = (corner_of(source, 3 * triangle + 1) - a) * source.scale,
               v = (corner_of(source, 3 * triangle + 2) - a) * source.scale;
    // Both edges at a length of about 1: nothing vanishes.
    const float u_length = length(u), v_length = length(v);
    const vec3 normal = cross(u / u_length, v / v_length);
    const float sine = length(normal);
    const bool found = sine > 64 * kError;
    error = found ? 32 * kError / sine : kInfinity;
    return found ? normal / sine : vec3(0);
}

void fit_cone(Source source, vec3 thinnest, inout Cluster cluster) {
    vec3 sum = vec3(0);
    float error;
    for (uint t = 0; t < source.count; ++t) sum += normal_of(source, t, error);
    const float size = length(sum);
    const bool found = size > 1e-3 * float(source.count);
    const vec3 axis = found ? sum / size : thinnest;
    float cosine = found ? 1 : -1;
    for (uint t = 0; t < source.count && cosine > 0; ++t) {
        const vec3 normal = normal_of(source, t, error);
        cosine = min(cosine, dot(normal, axis) - error);
    }
    // NaN, too, covers everything.
    const bool narrow = cosine > 0;
    cluster.axis = narrow ? axis : thinnest;
    cluster.cone_cosine = narrow ? cosine : -1.0;
}

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uint first = push.firsts.at[i];
        const Source source = open_source(first, push.marks.at[first]);
        const mat3 axes = principal_axes(source);
        const vec3 extents = extents_of(source, axes);
        vec3 a, b;
        if (kCapsules && extents.x >= kLongish * max(extents.y, extents.z)) {
            capsule_ends(source, axes, a, b);
        } else {
            float radius;
            a = smallest_center(source, mat3(1), radius);
            b = a;
        }
        Cluster cluster =
            Cluster(source.origin + a / source.scale, 0, source.origin + b / source.scale, 0,
                    vec3(0), 0, 0, first, source.count, 0);
        fit_cone(source, axes[2], cluster);
        fit_volume(source, cluster);
        push.clusters.at[i] = cluster;
    }
}
