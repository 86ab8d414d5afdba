// Any-hit query of a metric tree, a packet of segments with one stack: the hook of
// shadows/tiles/packets.glsl.
#ifndef SHADOWS_METRIC_TREE_PACKET_GLSL
#define SHADOWS_METRIC_TREE_PACKET_GLSL
#include "shadows/tiles/packets.glsl"
#include "shadows/metric_tree/shared_stack.glsl"

bool packet_occluded(Segment segment, uint own_primitive, bool asked, inout Walk walk,
                     out bool unsure) {
    const MetricHeader header = push.structure.header.header;
    const Question question = question_of(header.frame, segment.origin);
    bool hit = false;
    unsure = false;
    stack_depth = 0;
    stack_push(header.special != 0 && lane() == 0, header.special);
    stack_push(header.root != 0 && lane() == 0, header.root);
    while (stack_depth > 0) {
        if (walk.steps == 0) {
            walk.end = kEndStepLimit;
            break;
        }
        --walk.steps;
        ++walk.nodes;
        const uint id = node_of(subgroupShuffle(stack_pop(1), 0));
        const MetricNode node = metric_node(push.structure.nodes, id);
        Answer answer = ask(question, node, kUseDepth, kUseInterval);
        const bool alive = asked && !hit;
        const uint wanted = subgroupOr(
            !alive ? 0
                   : (answer.own ? 1 : 0) | (answer.near ? 2 : 0) | (answer.far ? 4 : 0) |
                         (answer.over ? 8 : 0));
        if ((wanted & 1u) != 0) {
            const Cluster cluster = cluster_at(push.structure.clusters, id);
            const bool meets = alive && answer.own && (!kUseSlabs || meets_slab(cluster, segment));
            if (subgroupAny(meets)) {
                uint i = 0;
                while (i < cluster.count) {
                    walk.steps -= min(walk.steps, 1u);
                    ++walk.triangles;
                    if (meets && !hit) {
                        const int verdict =
                            triangle_occludes(segment, cluster.first + i, own_primitive);
                        hit = verdict == 1;
                        unsure = unsure || verdict == kUnsure;
                    }
                    ++i;
                }
                if (!subgroupAny(asked && !hit)) break;
            }
        }
        // Lanes 0 to 2 push a subtree each; the last is visited first.
        const uint links[3] = uint[](node.over, node.far, node.near);
        const uint link = lane() == 0 ? links[0] : lane() == 1 ? links[1] : links[2];
        const uint bit = lane() == 0 ? 8u : lane() == 1 ? 4u : 2u;
        if (!stack_push(lane() < 3 && (wanted & bit) != 0, link)) {
            walk.end = kEndStackFull;
            break;
        }
    }
    return hit;
}

#endif
