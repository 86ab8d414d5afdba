// A triangle as leaf tests read it, one definition for C++ and GLSL (scalar layout): 40 bytes in a row
// instead of indices to follow.
#ifndef STRUCTURES_GEOMETRY_CORNER_TRIANGLE_H
#define STRUCTURES_GEOMETRY_CORNER_TRIANGLE_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace structures::geometry {
using namespace taskpool::gpu::shared_types;
#endif

struct CornerTriangle {  // world space
    vec3 a;
    vec3 b;
    vec3 c;
    uint primitive;
};

#ifdef __cplusplus
static_assert(sizeof(CornerTriangle) == 40 && offsetof(CornerTriangle, primitive) == 36);
}  // namespace structures::geometry
#endif
#endif
