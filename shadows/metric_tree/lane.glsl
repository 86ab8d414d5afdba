// Any-hit query of a metric tree, one segment per lane: the hook of shadows/tiles/lanes.glsl. With a
// stack, which holds overlapping subtrees to come back to; or stackless, by the links to ancestors (F.
// Deves et al. 2018, section 5.4). A full stack leaves the point to the walk that needs none.
#ifndef SHADOWS_METRIC_TREE_LANE_GLSL
#define SHADOWS_METRIC_TREE_LANE_GLSL
#include "shadows/tiles/lanes.glsl"

layout(constant_id = 23) const bool kStackless = false;

const uint kLaneStack = 64u;

/// Tests the cluster's triangles. Returns whether one occludes; `unsure` is set where double precision
/// cannot tell.
bool cluster_occludes(uint id, Segment s, uint own_primitive, bool last_resort, inout bool unsure,
                      inout Walk walk) {
    const Cluster cluster = cluster_at(push.structure.clusters, id);
    if (kUseSlabs && !meets_slab(cluster, s)) return false;
    // Guarded: drivers may run the body of a loop that has nothing to do.
    uint i = 0;
    while (true) {
        if (i == cluster.count) return false;
        const uint index = cluster.first + i++;
        // Lanes may loop in turns.
        const uint loops = kLoopsAreCut ? kLanes * take_exact_loops() : 0u;
        walk.steps -= min(walk.steps, 1u + loops);
        ++walk.triangles;
        const int answer = triangle_occludes(s, index, own_primitive);
        if (answer == 1) return true;
        if (answer == kUnsure) {
            if (!last_resort) {
                unsure = true;
            } else {
                const CornerTriangle t = push.structure.triangles.at[index];
                if (occludes_exactly(s, t.a, t.b, t.c)) return true;
            }
        }
    }
}

bool lane_occluded(Segment segment, uint own_primitive, bool last_resort, inout Walk walk) {
    const MetricHeader header = push.structure.header.header;
    const Question question = question_of(header.frame, segment.origin);
    uint stack[kLaneStack];
    uint depth = 0;
    uint link = header.root, rest = header.special;
    bool returning = false;  // stackless: to a node whose overlapping subtree is done
    bool unsure = false;
    while (true) {
        if (link == 0) {
            link = rest;
            rest = 0;
            returning = false;
            if (link == 0) break;
        }
        if (walk.steps == 0) {
            walk.end = kEndStepLimit;
            return false;
        }
        --walk.steps;
        ++walk.nodes;
        const uint id = node_of(link);
        const MetricNode node = metric_node(push.structure.nodes, id);
        const Answer answer = ask(question, node, kUseDepth, kUseInterval);
        if (answer.own && !returning &&
            cluster_occludes(id, segment, own_primitive, last_resort, unsure, walk))
            return true;
        // A point is never within reach of both the near and the far subtree.
        const uint onward = answer.near ? node.near : answer.far ? node.far : 0;
        if (kStackless) {
            const bool down = answer.over && !returning;
            returning = !down && onward == 0;
            link = down ? node.over : onward != 0 ? onward : node.ancestor;
        } else if (answer.over && onward != 0) {
            if (depth == min(kStackLimit, kLaneStack)) {
                walk.end = kEndStackFull;
                return false;
            }
            stack[depth++] = node.over;
            link = onward;
        } else {
            link = onward != 0 ? onward : answer.over ? node.over : depth > 0 ? stack[--depth] : 0;
        }
    }
    if (unsure) walk.end = kEndUnsure;
    return false;
}

#endif
