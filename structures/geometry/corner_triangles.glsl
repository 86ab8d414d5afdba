// Reading and writing CornerTriangles on the device.
#ifndef STRUCTURES_GEOMETRY_CORNER_TRIANGLES_GLSL
#define STRUCTURES_GEOMETRY_CORNER_TRIANGLES_GLSL
#include "taskpool/gpu/shared_types.h"
#include "structures/geometry/corner_triangle.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer CornerTriangles {
    CornerTriangle at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer CornerTriangleWords {
    uint64_t at[];
};

/// Triangle `index`, read by words of 64 bits: gathers go word by word on a CPU device.
CornerTriangle corner_triangle(CornerTriangles triangles, uint index) {
    CornerTriangleWords words = CornerTriangleWords(uint64_t(triangles));
    vec2 pair[5];
    [[unroll]] for (uint i = 0; i < 5; ++i)
        pair[i] = uintBitsToFloat(unpackUint2x32(words.at[5 * index + i]));
    return CornerTriangle(vec3(pair[0], pair[1].x), vec3(pair[1].y, pair[2]),
                          vec3(pair[3], pair[4].x), floatBitsToUint(pair[4].y));
}

#endif
