// Clusters of triangles and the nodes of a ternary metric tree over them, one definition for C++ and
// GLSL (scalar layout). F. Deves, F. Mora, L. Aveneau and D. Ghazanfarpour, "Scalable Real-Time
// Shadows using Clustering and Metric Trees", 2018.
//
// A cluster is a ball or a capsule (all points within `radius` of the segment ab; a == b: a ball)
// around a few triangles that are consecutive in the clustering's order. Seen from the light it is an
// *element*: the directions within `radius` of an arc (point light), or the places within `radius` of
// a segment in the plane across the light (directional). metric.glsl measures the distance of a
// direction to an arc: D below.
//
// Node i belongs to cluster i: it is the pivot that splits the elements of its three subtrees. A link
// is an index plus 1, in the bits of kLinkMask; 0: no such subtree. A query at distance D from the
// node's arc that reaches to depth d (how far the point is from the light) has to look
//   into the subtree itself (the node included) only if d >= min_depth,
//   at the cluster's triangles    if D <= radius,
//   into the near subtree         if D <= near_max,
//   into the far subtree          if D >= far_min,
//   into the overlapping subtree  if over_min <= D <= over_max.
// Special clusters concern every query. Their nodes are not in the tree but in a list, which begins at
// header.special and goes on along `over`; they have an infinite radius, bounds that hold always, and no ancestor.
//
// Every bound includes the radii of its elements and the errors of all distances, the query's own among
// them.
#ifndef STRUCTURES_METRIC_TREE_METRIC_TREE_SHARED_H
#define STRUCTURES_METRIC_TREE_METRIC_TREE_SHARED_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace structures::metric_tree {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kLinkMask = 0x07ffffffu;
/// 2^-18. A computed distance is off by less than a quarter of it, in radians, or in the scaled plane
/// across the light; see metric.glsl.
GROVE_CONSTANT float kMetricError = 3.814697265625e-6f;
/// Largest angular radius of an element, 60 degrees; clusters that look wider are special.
GROVE_CONSTANT float kWidestElement = 1.0471975512f;
/// Nodes on a path of a tree built by insertion, at most; elements that would come below are in a list
/// along the last node's overlapping link, whose nodes' bounds hold everything.
GROVE_CONSTANT uint kMaxDepth = 256;

struct Cluster {
    vec3 a;             // world space
    float radius;       // of the ball or capsule, rounded up
    vec3 b;
    float cone_cosine;  // all triangles' normals are within this cosine of `axis`; -1: any
    vec3 axis;          // unit length, roughly
    float slab_low;     // slab_low <= dot(axis, x) <= slab_high for every vertex x
    float slab_high;
    uint first;         // its triangles, in the clustering's order
    uint count;
    uint reserved;
};

struct MetricNode {
    vec3 a;            // ends of the arc: unit directions; or places across the light, z = 0
    float radius;      // of the element, widened by the errors
    vec3 b;
    float near_max;    // -1: nothing there
    uint near;
    uint far;
    uint over;
    uint ancestor;     // link to the parent of the overlapping subtree this node is in; 0: in none
    float min_depth;   // of the subtree; never negative
    float over_min;    // > over_max: nothing there
    float over_max;
    float far_min;     // infinite: nothing there
};

// How the light sees the scene; everything relative to `origin` and times `scale`.
struct LightFrame {
    vec3 origin;    // the light; or, directional, the middle of the scene
    float scale;    // power of two that takes the scene's size to between 1 and 2
    vec3 right;     // directional: basis of the plane across the light
    float start;    // directional: depth is dot(forward, x) + start, nowhere in the scene negative
    vec3 up;
    uint directional;
    vec3 forward;   // the way light travels
    float delta;    // point: angular radius of the scene's bounding sphere, pi from inside; directional:
                    // radius of the scene's disc
};

struct MetricHeader {
    LightFrame frame;
    uint root;           // link; 0: no tree
    uint cluster_count;
    uint special_count;  // clusters that are no elements: around the light or too wide
    uint inserted;       // elements in the tree
    uint culled_facing;  // clusters left out as they face away from the light
    uint culled_unseen;  // and as the mask of those to keep says
    uint bucketed;       // elements in lists at the end of chains
    uint depth_max;      // nodes on the longest path, those lists not counted
    uint special;        // link to the first special cluster's node
    uint reserved;
};

#ifdef __cplusplus
static_assert(sizeof(Cluster) == 64 && offsetof(Cluster, axis) == 32);
static_assert(sizeof(MetricNode) == 64 && offsetof(MetricNode, min_depth) == 48);
static_assert(sizeof(LightFrame) == 64);
static_assert(sizeof(MetricHeader) == 104 && offsetof(MetricHeader, root) == 64);
}  // namespace structures::metric_tree
#endif
#undef GROVE_CONSTANT
#endif
