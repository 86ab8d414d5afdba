// Clusters to elements: a node without subtrees for each, and the list of special ones. Nodes of
// clusters that are no elements have radius -1 and stay out of the tree.
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
    UintArray special;
    Header header;
    uint count;
    uint cull_facing;
} push;

MetricNode make_node(Element element, float min_depth) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    return MetricNode(element.a, element.radius, element.b, -1.0, 0, 0, 0, 0, min_depth, infinity,
                      -1.0, infinity);
}

void main() {
    const LightFrame frame = push.header.header.frame;
    uint culled = 0;
    // Uniform, for the ballot.
    for (uint first = gl_WorkGroupID.x * gl_SubgroupSize; first < push.count;
         first += gl_NumWorkGroups.x * gl_SubgroupSize) {
        const uint i = first + gl_SubgroupInvocationID;
        uint role = kRoleElement;
        if (i < push.count) {
            Element element;
            float min_depth;
            role = make_element(frame, push.clusters.at[i], push.cull_facing != 0, element, min_depth);
            if (role != kRoleElement) element.radius = -1;
            push.nodes.at[i] = make_node(element, min_depth);
        }
        culled += role == kRoleFacesAway ? 1 : 0;
        const uvec4 special = subgroupBallot(role == kRoleSpecial);
        const uint special_count = subgroupBallotBitCount(special);
        if (special_count == 0) continue;
        uint place = 0;
        if (subgroupElect()) place = atomicAdd(push.header.header.special_count, special_count);
        place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(special);
        if (role == kRoleSpecial) push.special.at[place] = i;
    }
    culled = subgroupAdd(culled);
    if (culled > 0 && subgroupElect()) atomicAdd(push.header.header.culled_facing, culled);
}
