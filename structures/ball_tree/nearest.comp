// Nearest points of a list of queries, one per lane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"
#include "structures/ball_tree/query.glsl"

layout(local_size_x_id = 0) in;

scalar_buffer(4) NearestArray { Nearest at[]; };

layout(push_constant, scalar) uniform Push {
    BallNodes nodes;
    BallPoints points;
    Vec3Array queries;
    NearestArray results;
    uint query_count;
    uint leaf_size;
} push;

void main() {
    const uint mine = gl_WorkGroupID.x * gl_SubgroupSize + gl_SubgroupInvocationID;
    if (mine >= push.query_count) return;
    BallTree tree = BallTree(push.nodes, push.points, push.leaf_size);
    push.results.at[mine] = ball_tree_nearest(tree, push.queries.at[mine]);
}
