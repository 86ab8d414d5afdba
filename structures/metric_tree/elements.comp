// Clusters to elements: a node without subtrees for each. The nodes of special clusters become a list,
// those of clusters that are left out have radius -1.
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
    UintArray keep;  // null: all; else a bit per cluster
    uint count;
    uint cull_facing;
} push;

bool is_kept(uint id) {
    return uint64_t(push.keep) == 0 || (push.keep.at[id / 32] >> id % 32 & 1u) != 0;
}

MetricNode make_node(Element element, float min_depth) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    return MetricNode(element.a, element.radius, element.b, -1.0, 0, 0, 0, 0, min_depth, infinity,
                      -1.0, infinity);
}

/// In front of the list of special clusters; everything passes it by.
MetricNode make_special(uint id) {
    const uint next = atomicExchange(push.header.header.special, id + 1);
    const float infinity = uintBitsToFloat(0x7f800000u);
    return MetricNode(vec3(1, 0, 0), infinity, vec3(1, 0, 0), -1.0, 0, 0, next, 0, 0.0, 0.0, infinity,
                      infinity);
}

void main() {
    const LightFrame frame = push.header.header.frame;
    uint culled = 0, unseen = 0, special = 0;
    for (uint i = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID; i < push.count;
         i += gl_NumWorkGroups.x * gl_SubgroupSize) {
        Element element;
        float min_depth;
        const uint role =
            make_element(frame, push.clusters.at[i], push.cull_facing != 0, element, min_depth);
        const bool faces_away = role == kRoleFacesAway, kept = is_kept(i);
        if (faces_away || !kept) element.radius = -1;
        MetricNode node = make_node(element, min_depth);
        if (role == kRoleSpecial && kept) node = make_special(i);
        push.nodes.at[i] = node;
        culled += faces_away ? 1 : 0;
        unseen += !faces_away && !kept ? 1 : 0;
        special += role == kRoleSpecial && kept ? 1 : 0;
    }
    culled = subgroupAdd(culled);
    unseen = subgroupAdd(unseen);
    special = subgroupAdd(special);
    if (culled > 0 && subgroupElect()) atomicAdd(push.header.header.culled_facing, culled);
    if (unseen > 0 && subgroupElect()) atomicAdd(push.header.header.culled_unseen, unseen);
    if (special > 0 && subgroupElect()) atomicAdd(push.header.header.special_count, special);
}
