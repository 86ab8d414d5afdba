// An 8-wide BVH with boxes on a 16-bit grid, one definition for C++ and GLSL (scalar layout).
//
// Node 0 is the root; a tree without nodes has header.node_count == 0. A node's inner children come
// first, in consecutive nodes: child slot s of a node whose slot 0 links to node b is node b + s.
// Then its leaves, then empty slots. The three words of a child's box hold, per axis, lower and
// upper bound on the grid (low and high 16 bits): coordinate = header.origin + header.cell * bound.
//
// The box contains the exact box. Let x = (coordinate - origin) / cell, at most 65,535, as computed
// in fp32: two roundings, so it errs by at most 2 * 2^-24 * 65,535 < 2^-7. The lower bound is
// floor(x - kGridMargin), the upper ceil(x + kGridMargin), with kGridMargin = 2^-4, and the cell is
// so large that the largest coordinate lies at 65,000 or below; a bound clamped to 0 stands for
// the origin itself, the lower corner of everything. Whoever decodes a bound must widen the result
// by the rounding of his own arithmetic (wide_node.glsl).
#ifndef STRUCTURES_BVH_WIDE_WIDE_SHARED_H
#define STRUCTURES_BVH_WIDE_WIDE_SHARED_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace structures::bvh::wide {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kWidth = 8u;
// A child's link: an inner node's index; or this bit, a count of 1 to 7 and the first triangle.
GROVE_CONSTANT uint kLeafBit = 0x80000000u;
GROVE_CONSTANT uint kLeafCountShift = 28u;
GROVE_CONSTANT uint kMaxLeafCount = 7u;
GROVE_CONSTANT uint kLeafFirstMask = 0x0fffffffu;
// No child. (As a leaf: 7 triangles at the last possible place, which is never used.)
GROVE_CONSTANT uint kEmptyLink = 0xffffffffu;
// Node indices fit in 24 bits, so that a stack entry is one word: index of slot 0, mask of slots.
GROVE_CONSTANT uint kMaxNodes = 0x1000000u;
GROVE_CONSTANT float kGridTop = 65000.0f;
GROVE_CONSTANT float kGridMargin = 0.0625f;

struct WideChild {
    uint x;
    uint y;
    uint z;
    uint link;
};

struct WideHeader {
    vec3 origin;      // lower corner of the scene
    uint node_count;  // finished and waiting nodes
    vec3 cell;        // size of a grid cell
    uint pending;     // nodes that wait for another recording: 0 when the tree is finished
    vec3 upper;       // upper corner of the scene
    uint depth;       // levels of nodes
};

// What becomes a node: a node of the binary tree, or (count > 0) a part of a large leaf.
struct WideItem {
    uint node;
    uint first;
    uint count;
};

// One level while it is built: workgroups of its dispatches, and its range of nodes.
struct WideLevel {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint begin;
    uint end;
};
// Nodes of a level that one workgroup handles at a time.
GROVE_CONSTANT uint kChunk = 64u;

#ifdef __cplusplus
static_assert(sizeof(WideChild) == 16);
static_assert(sizeof(WideHeader) == 48 && offsetof(WideHeader, cell) == 16);
static_assert(sizeof(WideItem) == 12 && sizeof(WideLevel) == 20);
}  // namespace structures::bvh::wide
#endif
#undef GROVE_CONSTANT
#endif
