// What the kernels of the metric tree's shadow query share: the tree, how the light sees a point, and
// which clusters a segment meets.
#include "taskpool/gpu/device.glsl"
layout(constant_id = 1) const bool kDirectional = false;
layout(constant_id = 24) const bool kCapsules = true;  // false: all clusters are balls
#include "structures/metric_tree/tree.glsl"

struct Structure {
    MetricHeaderRef header;
    MetricNodes nodes;
    Clusters clusters;
    CornerTriangles triangles;
};
#include "shadows/tiles/tiles.glsl"
#include "shadows/metric_tree/question.glsl"

// Each can be turned off, to measure what it saves.
layout(constant_id = 20) const bool kUseDepth = true;     // subtrees behind the point
layout(constant_id = 21) const bool kUseInterval = true;  // overlapping subtrees out of reach
layout(constant_id = 22) const bool kUseSlabs = true;     // clusters whose slab the segment misses

vec3 asked_from(vec3 p) { return p; }

/// Whether the segment may meet the cluster's triangles: somewhere along it, within the cluster's reach,
/// between the planes of the slab. Not a number counts as yes.
bool meets_slab(Cluster cluster, Segment s) {
    const vec3 way = s.directional ? s.target : s.target - s.origin;
    const vec3 to_a = cluster.a - s.origin, to_b = cluster.b - s.origin;
    const float square = dot(way, way), inverse = 1.0 / square, pace = sqrt(square);
    const float at_a = dot(to_a, way), at_b = dot(to_b, way);
    const float margin = (cluster.radius + kRound * (norm1(to_a) + norm1(to_b))) * pace;
    const float first = max((min(at_a, at_b) - margin) * inverse, 0.0);
    const float beyond = (max(at_a, at_b) + margin) * inverse;
    const float last = s.directional ? beyond : min(beyond, 1.0);
    if (last < first) return false;
    const float base = dot(cluster.axis, s.origin), slope = dot(cluster.axis, way);
    const float x = base + first * slope, y = base + last * slope;
    const float error = kRound * (norm1(s.origin) + last * norm1(way));
    return !(max(x, y) < cluster.slab_low - error || min(x, y) > cluster.slab_high + error);
}

/// One triangle against the segment: 1, 0 or kUnsure.
int triangle_occludes(Segment s, uint index, uint own_primitive) {
    const CornerTriangle t = push.structure.triangles.at[index];
    if (t.primitive == own_primitive) return 0;
    return occludes_quickly(s, t.a, t.b, t.c);
}
