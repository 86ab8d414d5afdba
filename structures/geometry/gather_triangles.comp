// Triangles in the order of a structure: see gather_triangles.hpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
#include "structures/geometry/corner_triangles.glsl"
layout(local_size_x_id = 0) in;

layout(push_constant, scalar) uniform Push {
    UintArray order;
    Vec3Array positions;
    Uvec3Array corners;
    CornerTriangles triangles;
    uint count;
    uint triangle_count;
} push;

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uint primitive = push.order.at[i];
        CornerTriangle t = CornerTriangle(vec3(0), vec3(0), vec3(0), 0xffffffffu);
        if (primitive < push.triangle_count) {
            const uvec3 corner = push.corners.at[primitive];
            t = CornerTriangle(push.positions.at[corner.x], push.positions.at[corner.y],
                             push.positions.at[corner.z], primitive);
        }
        push.triangles.at[i] = t;
    }
}
