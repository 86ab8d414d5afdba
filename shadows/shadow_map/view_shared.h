// What C++ and the shaders of the shadow map share: views, bounds, push constants.
#ifndef SHADOWS_SHADOW_MAP_VIEW_SHARED_H
#define SHADOWS_SHADOW_MAP_VIEW_SHARED_H

#ifdef __cplusplus
#include "taskpool/gpu/shared_types.h"

namespace shadows::shadow_map {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kFaces = 6u;

// The light's coordinates: see view.glsl.
struct Frame {
    vec3 origin;                // the light; of a directional one, the middle of the casters
    vec3 right, down, forward;  // of a directional light: its travel is `forward`
};

// One map: a face of a point light's cube, or the only one of a directional light.
struct View {
    vec2 scale, offset;  // place on the map, -1 to 1: scale * s + offset; no map: scale 0, offset 2
    float near;          // depth: near / w; directional: near - per_depth * w
    float per_depth;
    float bias;  // how far a stored depth is moved back: this part of it; directional: this much
    uint slot;   // of the map, among those there are
};

// Bounds of what a view sees, in the order of kNear ..., each as an ordered word (ordered.glsl).
GROVE_CONSTANT uint kNear = 0u, kMinusFar = 1u, kLeft = 2u, kTop = 3u, kMinusRight = 4u,
                    kMinusBottom = 5u, kBounds = 6u;
struct Fit {
    uint casters[kFaces];  // triangles that may reach into the face
    uint bounds[kFaces * kBounds];
};

struct FitPush {
    uint64_t positions, triangles;
    uint64_t casters;  // of each face, triangle_count ids
    uint64_t fit;
    Frame frame;
    uint triangle_count;
    float reach;  // half the width of a face, 1 and a little more for a texel's centre
};

struct DepthPush {
    uint64_t positions, triangles, casters;
    Frame frame;
    View view;
    uint face;
};

struct LookupPush {
    uint64_t points, visible;
    uint64_t views, maps;
    uint64_t normals;  // with receiver planes: by primitive id
    Frame frame;
    uint resolution, point_count;
};

#ifdef __cplusplus
static_assert(sizeof(Frame) == 48);
static_assert(sizeof(View) == 32);
static_assert(sizeof(Fit) == 168);
static_assert(sizeof(FitPush) == 88);
static_assert(sizeof(DepthPush) == 112);
static_assert(sizeof(LookupPush) == 96);
}  // namespace shadows::shadow_map
#endif
#undef GROVE_CONSTANT
#endif
