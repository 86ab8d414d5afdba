// The node of a binary BVH, one definition for C++ and GLSL (scalar layout).
//
// Node 0 is the root. count == 0: an inner node whose children are nodes `first` and `first + 1`.
// count > 0: a leaf holding primitives order[first .. first + count). Node 0 is nobody's child, so
// count == 0 with first == 0 means an empty tree, which every traversal must test at the root; its
// box is empty (lower = +inf, upper = -inf). An array of nodes may have holes that no link reaches:
// walk from the root, never over the array.
#ifndef STRUCTURES_BVH_BVH_SHARED_H
#define STRUCTURES_BVH_BVH_SHARED_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace structures::bvh {
using namespace taskpool::gpu::shared_types;
#endif

struct BvhNode {
    vec3 lower;
    uint first;
    vec3 upper;
    uint count;
};

#ifdef __cplusplus
static_assert(sizeof(BvhNode) == 32);
static_assert(offsetof(BvhNode, first) == 12);
static_assert(offsetof(BvhNode, upper) == 16);
static_assert(offsetof(BvhNode, count) == 28);
}  // namespace structures::bvh
#endif
#endif
