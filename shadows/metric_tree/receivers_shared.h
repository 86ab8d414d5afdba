// How deep the light looks, by direction, for C++ and GLSL: see receivers.hpp.
#ifndef SHADOWS_METRIC_TREE_RECEIVERS_SHARED_H
#define SHADOWS_METRIC_TREE_RECEIVERS_SHARED_H
#ifdef __cplusplus
#include "taskpool/gpu/shared_types.h"
namespace shadows::metric_tree {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kMapLevels = 9u;  // level 0 has the finest texels
GROVE_CONSTANT uint kMapSide = 1u << (kMapLevels - 1u);
/// Texels of a face, all levels: a third more than those of the finest, less a fraction.
GROVE_CONSTANT uint kFaceTexels = (4u * kMapSide * kMapSide - 1u) / 3u;
GROVE_CONSTANT uint kFaces = 6u;  // of the cube around a point light; a directional one has one

#ifdef __cplusplus
}  // namespace shadows::metric_tree
#endif
#undef GROVE_CONSTANT
#endif
