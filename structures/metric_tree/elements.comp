// Clusters to elements: a node without subtrees for each, but the special ones' are linked in a list.
// Clusters that are no elements have
// an infinite radius, by which the builders know them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
#include "structures/metric_tree/metric_tree_shared.h"
layout(local_size_x_id = 0) in;
layout(constant_id = 16) const bool kDirectional = false;
layout(constant_id = 17) const bool kCapsules = true;
#include "structures/metric_tree/metric.glsl"
#include "structures/metric_tree/elements.glsl"

scalar_buffer(16) readonly Clusters { Cluster at[]; };
scalar_buffer(16) writeonly Nodes { MetricNode at[]; };
scalar_buffer(4) Header { MetricHeader header; };

layout(push_constant, scalar) uniform Push {
    Clusters clusters;
    Nodes nodes;
    Header header;
    uint count;
    uint cull_facing;
} push;


void main() {
    const float infinity = uintBitsToFloat(0x7f800000u);
    const LightFrame frame = push.header.header.frame;
    uint special_count = 0, culled_count = 0;
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        Element element;
        float min_depth;
        const uint role =
            make_element(frame, push.clusters.at[i], push.cull_facing != 0, element, min_depth);
        MetricNode node = MetricNode(element.a, element.radius, element.b, -1.0, 0, 0, 0, 0, min_depth,
                                     infinity, -1.0, infinity);
        if (role != kRoleElement) {
            node.a = node.b = vec3(1, 0, 0);
            node.radius = infinity;
        }
        if (role == kRoleSpecial) {
            node.over = atomicExchange(push.header.header.special, i + 1);
            node.min_depth = node.over_min = 0;
            node.over_max = infinity;
            ++special_count;
        }
        if (role == kRoleFacesAway) ++culled_count;
        push.nodes.at[i] = node;
    }
    special_count = subgroupAdd(special_count);
    culled_count = subgroupAdd(culled_count);
    if (!subgroupElect()) return;
    if (special_count > 0) atomicAdd(push.header.header.special_count, special_count);
    if (culled_count > 0) atomicAdd(push.header.header.culled_facing, culled_count);
}
