// Morton codes of the triangles' centroids, 16 bits for each axis; kLeftOut for degenerate
// triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
layout(local_size_x_id = 0) in;

scalar_buffer(8) writeonly Codes { uint64_t at[]; };

layout(push_constant, scalar) uniform Push {
    Vec3Array positions;
    Uvec3Array triangles;
    Codes codes;
    UintArray ids;
    UintArray kept;  // one word: triangles that are not left out
    uint count;
    vec3 lower;     // of the mesh
    float inverse;  // of its largest extent
}
push;

const uint64_t kLeftOut = 0xfffffffffffful;

/// Exactly no area or a corner that is not finite, as TriangleMesh::degenerate decides it.
bool degenerate(vec3 a, vec3 b, vec3 c) {
    precise dvec3 u = dvec3(b) - dvec3(a), v = dvec3(c) - dvec3(a);
    precise dvec3 normal =
        dvec3(u.y * v.z - v.y * u.z, u.z * v.x - v.z * u.x, u.x * v.y - v.x * u.y);
    precise double square = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
    return !(square > 0.0LF && square < 1e300LF);
}

/// Two zeros before each of 16 bits.
uint64_t spread(uint bits) {
    uint64_t code = bits;
    code = (code | code << 16) & 0x0000ff0000fful;
    code = (code | code << 8) & 0x00f00f00f00ful;
    code = (code | code << 4) & 0x0c30c30c30c3ul;
    code = (code | code << 2) & 0x249249249249ul;
    return code;
}

void main() {
    uint kept = 0;
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uvec3 corners = push.triangles.at[i];
        const vec3 a = push.positions.at[corners.x], b = push.positions.at[corners.y],
                   c = push.positions.at[corners.z];
        const bool valid = !degenerate(a, b, c);
        // Divided before they are summed: no overflow. The last cell is kLeftOut's.
        const float third = 1.0 / 3.0;
        const vec3 center = a * third + b * third + c * third;
        const uvec3 cell =
            uvec3(clamp((center - push.lower) * push.inverse * 65535.0, 0.0, 65534.0));
        push.codes.at[i] =
            valid ? spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z) : kLeftOut;
        push.ids.at[i] = i;
        kept += valid ? 1 : 0;
    }
    kept = subgroupAdd(kept);
    if (subgroupElect()) atomicAdd(push.kept.at[0], kept);
}
