// Step 5: the triangles in leaf order, corners in place: a leaf test reads 40 bytes in a row.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
#include "taskpool/gpu/shared_types.h"
#include "structures/bvh/wide/wide_shared.h"
layout(local_size_x_id = 0) in;

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Triangles { WideTriangle at[]; };
layout(push_constant, scalar) uniform Push {
    UintArray order;
    Vec3Array positions;
    Uvec3Array corners;
    Triangles triangles;
    uint count;
    uint triangle_count;
} push;

void main() {
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uint primitive = push.order.at[i];
        WideTriangle t = WideTriangle(vec3(0), vec3(0), vec3(0), 0xffffffffu);
        if (primitive < push.triangle_count) {
            const uvec3 corner = push.corners.at[primitive];
            t = WideTriangle(push.positions.at[corner.x], push.positions.at[corner.y],
                             push.positions.at[corner.z], primitive);
        }
        push.triangles.at[i] = t;
    }
}
