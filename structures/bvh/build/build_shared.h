// What the BVH build on the task pool (build.comp) and its host side (bvh.cpp) both know.
#ifndef STRUCTURES_BVH_BUILD_SHARED_H
#define STRUCTURES_BVH_BUILD_SHARED_H

#include "taskpool/gpu/shared_types.h"

#ifdef __cplusplus
#include <cstddef>
namespace structures::bvh {
using namespace taskpool::gpu::shared_types;
#define BVH_CONSTANT constexpr
#else
#define BVH_CONSTANT const
#endif

// Phases of a task, in the order a task may run through them.
BVH_CONSTANT uint kPhaseSetup = 0;      // boxes of the triangles, scene bounds, degenerate ones
BVH_CONSTANT uint kPhaseCompact = 1;    // closes the gaps that degenerate triangles left
BVH_CONSTANT uint kPhaseBins = 2;       // SAH over bins of a large range
BVH_CONSTANT uint kPhaseCount = 3;      // per chunk, how many primitives go left
BVH_CONSTANT uint kPhasePartition = 4;  // moves them
BVH_CONSTANT uint kPhaseSmall = 5;      // chooses a split and partitions, in one go
BVH_CONSTANT uint kPhaseSubtree = 6;    // all that is below a range of few primitives, in one go

BVH_CONSTANT uint kChunkPrimitives = 1024;  // in a chunk, and in a small task at most
BVH_CONSTANT uint kFewPrimitives = 32;      // so few get another look
BVH_CONSTANT uint kSubtreePrimitives = 48;  // in a range whose subtree is built in one go, at most
BVH_CONSTANT uint kBins = 16;               // of an axis, a power of two
BVH_CONSTANT uint kKeys = 6;                // of a box: see keys_of() in keys.glsl

// A triangle's box.
struct Primitive {
    vec3 lower;
    uint id;  // of the triangle; kNoPrimitive if it is degenerate
    vec3 upper;
};
BVH_CONSTANT uint kNoPrimitive = 0xffffffffu;

// The mesh.
struct BuildInput {
#ifdef __cplusplus
    std::uint64_t positions, triangles;
#else
    Vec3Array positions;
    Uvec3Array triangles;
#endif
    uint triangle_count;
    uint padding;
};

#ifdef __cplusplus
static_assert(sizeof(Primitive) == 28);
static_assert(sizeof(BuildInput) == 24);
}  // namespace structures::bvh
#endif
#undef BVH_CONSTANT
#endif
