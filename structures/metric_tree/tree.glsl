// Reading a metric tree in a shader; see metric_tree_shared.h. The includer defines kDirectional and kCapsules.
#ifndef STRUCTURES_METRIC_TREE_TREE_GLSL
#define STRUCTURES_METRIC_TREE_TREE_GLSL
#include "taskpool/gpu/shared_types.h"
#include "structures/geometry/corner_triangles.glsl"
#include "structures/metric_tree/metric_tree_shared.h"
#include "structures/metric_tree/metric.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MetricHeaderRef {
    MetricHeader header;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MetricNodes {
    MetricNode at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Clusters {
    Cluster at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MetricWords {
    uint64_t at[];
};

// Nodes and clusters read by words of 64 bits: gathers go word by word on a CPU device.
MetricNode metric_node(MetricNodes nodes, uint id) {
    MetricWords words = MetricWords(uint64_t(nodes) + uint64_t(id) * 64);
    uvec2 w[8];
    [[unroll]] for (uint i = 0; i < 8; ++i) w[i] = unpackUint2x32(words.at[i]);
    return MetricNode(uintBitsToFloat(uvec3(w[0], w[1].x)), uintBitsToFloat(w[1].y),
                      uintBitsToFloat(uvec3(w[2], w[3].x)), uintBitsToFloat(w[3].y), w[4].x, w[4].y,
                      w[5].x, w[5].y, uintBitsToFloat(w[6].x), uintBitsToFloat(w[6].y),
                      uintBitsToFloat(w[7].x), uintBitsToFloat(w[7].y));
}
Cluster cluster_at(Clusters clusters, uint id) {
    MetricWords words = MetricWords(uint64_t(clusters) + uint64_t(id) * 64);
    uvec2 w[8];
    [[unroll]] for (uint i = 0; i < 8; ++i) w[i] = unpackUint2x32(words.at[i]);
    return Cluster(uintBitsToFloat(uvec3(w[0], w[1].x)), uintBitsToFloat(w[1].y),
                   uintBitsToFloat(uvec3(w[2], w[3].x)), uintBitsToFloat(w[3].y),
                   uintBitsToFloat(uvec3(w[4], w[5].x)), uintBitsToFloat(w[5].y),
                   uintBitsToFloat(w[6].x), w[6].y, w[7].x, w[7].y);
}

/// Index of the node or cluster that a link, not 0, leads to.
uint node_of(uint link) { return (link & kLinkMask) - 1; }

/// What a query asks the tree about: everything within `radius` of a direction (or of a place across the
/// light) and no deeper than `depth`.
struct Question {
    vec3 center;
    float radius;
    float depth;
};

/// The subtrees that may hold elements the question meets, and whether the node's own does.
struct Answer {
    bool open;  // else there is nothing in the whole subtree
    bool own, near, far, over;
};

Answer ask(Question q, MetricNode node, bool use_depth, bool use_interval) {
    Answer answer;
    answer.open = !(use_depth && q.depth < node.min_depth);
    const float d = distance_to(q.center, node.a, node.b), least = d - q.radius, most = d + q.radius;
    answer.own = answer.open && least <= node.radius;
    answer.near = answer.open && node.near != 0 && least <= node.near_max;
    answer.far = answer.open && node.far != 0 && most >= node.far_min;
    answer.over = answer.open && node.over != 0 &&
                  (!use_interval || (most >= node.over_min && least <= node.over_max));
    return answer;
}

#endif
