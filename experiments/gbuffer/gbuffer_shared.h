// Push constants of the G-buffer's shaders, for C++ and GLSL.
#include "taskpool/gpu/shared_types.h"
#ifdef __cplusplus
namespace experiments::gbuffer {
using namespace taskpool::gpu::shared_types;
#endif

/// visibility.vert and .frag. A point p is at clip = (row_x . r, row_y . r, near, row_w . r) with
/// r = p - eye: subtracting the eye first keeps full precision far from the origin.
struct VisibilityPush {
    uint64_t positions, triangles;  ///< addresses
    vec3 eye;
    vec3 row_x, row_y, row_w;
    float near;
    vec2 ndc_per_pixel;  ///< 2 / width, 2 / height
};

/// resolve.comp. The ray through the centre of pixel (x, y) has direction
/// origin + (x + 0.5) right + (y + 0.5) down.
struct ResolvePush {
    dvec3 origin, right, down;
    uint64_t positions, triangles;  ///< addresses of the mesh
    uint64_t ids;                   ///< address of the primitive ids, row by row
    uint64_t points;  ///< address of seven planes of words: x, y, z, primitive, normal x, y, z
    vec3 eye;
    uint width, height;
};

#ifdef __cplusplus
static_assert(sizeof(VisibilityPush) == 80);
static_assert(sizeof(ResolvePush) == 128);
}  // namespace experiments::gbuffer
#endif
