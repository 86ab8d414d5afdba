// The leaf tests that the BVH query knows, for C++ and GLSL: see leaf_variants.glsl.
#ifndef SHADOWS_BVH_LEAF_SHARED_H
#define SHADOWS_BVH_LEAF_SHARED_H
#ifdef __cplusplus
#include "taskpool/gpu/shared_types.h"
namespace shadows::bvh {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kLeafExact = 0u;
GROVE_CONSTANT uint kLeafWatertight = 1u;
GROVE_CONSTANT uint kLeafMoellerTrumbore = 2u;
GROVE_CONSTANT uint kLeafDouble = 3u;

#ifdef __cplusplus
}  // namespace shadows::bvh
#endif
#undef GROVE_CONSTANT
#endif
