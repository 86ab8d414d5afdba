// Step 3 of the G-buffer: the point, and the normal, that each pixel's centre sees.
//
// One workgroup per tile of 16 x 16 pixels; points leave in the order of shadows/points.hpp. The
// point is found in double precision and rounded once. It is a convex combination of the corners'
// own coordinates, so on an axis-aligned triangle it has exactly the triangle's coordinate.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "experiments/gbuffer/gbuffer_shared.h"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Block { ResolvePush push; };

const uint kTileSide = 16;
const uint kTilePoints = kTileSide * kTileSide;
const uint kNoPrimitive = 0xffffffffu;

/// Weights of the point of edge ab (as seen from the eye) nearest to the ray, and in `miss` the
/// squared sine of the angle between them.
dvec2 nearest_on_edge(dvec3 a, dvec3 b, dvec3 direction, out double miss) {
    // In the plane across the ray: nearest approach of the segment a, b to the origin.
    double scale = 1.0 / dot(direction, direction);
    dvec3 a_across = a - direction * (dot(a, direction) * scale);
    dvec3 edge = b - a;
    dvec3 edge_across = edge - direction * (dot(edge, direction) * scale);
    double length2 = dot(edge_across, edge_across);
    double t = length2 > 0.0 ? clamp(-dot(a_across, edge_across) / length2, 0.0LF, 1.0LF) : 0.0LF;
    dvec3 point = a + t * edge;
    dvec3 across = a_across + t * edge_across;
    double behind = dot(point, direction) > 0.0 ? 0.0LF : 2.0LF;
    miss = behind + dot(across, across) / max(dot(point, point), 1e-300LF);
    return dvec2(1.0 - t, t);
}

/// Barycentric coordinates (not negative, sum > 0) of the point of triangle abc, given relative to
/// the eye, that the ray hits; of the nearest one on its edges where rounding let the ray miss.
dvec3 visible_point(dvec3 a, dvec3 b, dvec3 c, dvec3 direction) {
    dvec3 volumes = dvec3(dot(direction, cross(b, c)), dot(direction, cross(c, a)),
                          dot(direction, cross(a, b)));
    double det = volumes.x + volumes.y + volumes.z;
    if (det < 0.0) volumes = -volumes;
    if (det != 0.0 && all(greaterThanEqual(volumes, dvec3(0)))) return volumes / abs(det);
    double miss_ab, miss_bc, miss_ca;
    dvec2 ab = nearest_on_edge(a, b, direction, miss_ab);
    dvec2 bc = nearest_on_edge(b, c, direction, miss_bc);
    dvec2 ca = nearest_on_edge(c, a, direction, miss_ca);
    if (miss_ab <= miss_bc && miss_ab <= miss_ca) return dvec3(ab, 0);
    return miss_bc <= miss_ca ? dvec3(0, bc) : dvec3(ca.y, 0, ca.x);
}

void main() {
    uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kTilePoints;
    UintArray primitives = UintArray(push.points + 12ul * count);
    FloatArray points = FloatArray(push.points);
    for (uint i = gl_SubgroupInvocationID; i < kTilePoints; i += gl_SubgroupSize) {
        uint block = i / 16;
        uvec2 pixel = gl_WorkGroupID.xy * kTileSide +
                      uvec2(block % 4 * 4 + i % 4, block / 4 * 4 + i % 16 / 4);
        uint primitive = kNoPrimitive;
        if (pixel.x < push.width && pixel.y < push.height)
            primitive = UintArray(push.ids).at[pixel.y * push.width + pixel.x];
        vec3 point = vec3(0), normal = vec3(0);
        if (primitive != kNoPrimitive) {
            uvec3 vertices = Uvec3Array(push.triangles).at[primitive];
            dvec3 a = dvec3(Vec3Array(push.positions).at[vertices.x]);
            dvec3 b = dvec3(Vec3Array(push.positions).at[vertices.y]);
            dvec3 c = dvec3(Vec3Array(push.positions).at[vertices.z]);
            dvec3 eye = dvec3(push.eye);
            dvec3 direction = push.origin + (double(pixel.x) + 0.5) * push.right +
                              (double(pixel.y) + 0.5) * push.down;
            dvec3 weights = visible_point(a - eye, b - eye, c - eye, direction);
            point = vec3(weights.x * a + weights.y * b + weights.z * c);
            dvec3 n = cross(b - a, c - a);
            if (dot(n, a - eye) > 0.0) n = -n;
            normal = vec3(n / sqrt(dot(n, n)));
        }
        uint at = tile * kTilePoints + i;
        points.at[at] = point.x;
        points.at[count + at] = point.y;
        points.at[2 * count + at] = point.z;
        primitives.at[at] = primitive;
        points.at[4 * count + at] = normal.x;
        points.at[5 * count + at] = normal.y;
        points.at[6 * count + at] = normal.z;
    }
}
