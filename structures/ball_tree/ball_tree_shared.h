// The ball tree in memory, and what its build (build.comp, ball_tree.cpp) shares; C++ and GLSL.
//
// Node 0 is the root. count == 0: an inner node whose children are nodes `first` and `first + 1`.
// count > 0: a leaf of points [first, first + count); one of more points than the leaf size holds
// copies of a single position. Node 0 is nobody's child: count == 0 with first == 0 is an empty
// tree. The array has holes that no link reaches.
#ifndef STRUCTURES_BALL_TREE_SHARED_H
#define STRUCTURES_BALL_TREE_SHARED_H

#include "taskpool/gpu/shared_types.h"

#ifdef __cplusplus
namespace structures::ball_tree {
using namespace taskpool::gpu::shared_types;
#define BALL_TREE_CONSTANT constexpr
#else
#define BALL_TREE_CONSTANT const
#endif

BALL_TREE_CONSTANT uint kMaxDepth = 64;  // of a node; the root has depth 0
BALL_TREE_CONSTANT uint kNoPoint = 0xffffffffu;

// All points below lie within sqrt(radius_squared) of the centre. Squared, because a GPU's root is
// not rounded like another's: the tree is the same, bit for bit, everywhere.
struct BallNode {
    vec3 center;
    float radius_squared;
    uint first, count;
};

// The centroid of triangle `id`.
struct BallPoint {
    vec3 position;
    uint id;
};

// Answer to one query; of an empty tree, kNoPoint and infinity.
struct Nearest {
    uint id;
    float distance_squared;
};

// Phases of a build's task.
BALL_TREE_CONSTANT uint kPhaseSetup = 0;      // root only: triangles to points
BALL_TREE_CONSTANT uint kPhaseMeasure = 1;    // radius, and how many points of each chunk go left
BALL_TREE_CONSTANT uint kPhasePartition = 2;  // moves them; bounds of both sides
BALL_TREE_CONSTANT uint kPhaseLeaf = 3;

BALL_TREE_CONSTANT uint kChunkPoints = 1024;  // in a chunk at least, unless the task has fewer
// Node of the root task, which owns all triangles and drops the degenerate ones.
BALL_TREE_CONSTANT uint kNoNode = 0xffffffffu;

// What the chunks of a task tell each other.
struct Gather {
    uint left_count;      // of one chunk; after the scan, of the chunks before it
    uint radius_squared;  // bits of the float
    uint bounds[12];      // keys: lower and upper corner of the left side, then of the right one
};

#ifdef __cplusplus
static_assert(sizeof(BallNode) == 24 && sizeof(BallPoint) == 16 && sizeof(Nearest) == 8);
static_assert(sizeof(Gather) == 56);
}  // namespace structures::ball_tree
#endif
#undef BALL_TREE_CONSTANT
#endif
