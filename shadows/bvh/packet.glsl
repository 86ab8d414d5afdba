// Packets: a subgroup's segments, neighbours on the screen, share one stack and walk together
// wherever one of them has to go. Lanes load a node's children once and pass them round; a packet
// that runs out of stack or steps is left to the per-point walk, and so are points that meet a
// triangle that double precision cannot tell.
#ifndef SHADOWS_BVH_PACKET_GLSL
#define SHADOWS_BVH_PACKET_GLSL
#include "shadows/bvh/any_hit.glsl"
#include "shadows/bvh/subgroup_stack.glsl"

// `unsure`: some triangle is left to the per-point walk, which matters if there is no hit.
bool packet_occluded(Segment segment, uint own_primitive, bool asked, inout BvhWalk walk,
                     out bool unsure) {
    const WideHeader header = push.header.header;
    const SlabTest test = slab_test(header, segment);
    bool hit = false;
    unsure = false;
    uint entry = header.node_count > 0 ? 1u : 0u;
    stack_depth = 0;
    while (true) {
        if ((entry & 0xffu) == 0) {
            if (stack_depth == 0) break;
            entry = stack_pop();
        }
        if (walk.steps == 0) {
            walk.end = kEndStepLimit;
            break;
        }
        --walk.steps;
        const uint node = (entry >> 8) + findLSB(entry & 0xffu);
        entry &= entry - 1u;
        const uvec4 loaded = push.nodes.at[node * kWidth + lane() % kWidth];
        uint inner = 0, leaves = 0;
        [[unroll]] for (uint slot = 0; slot < kWidth; ++slot) {
            const uvec4 child = subgroupShuffle(loaded, slot);
            const uint bit = asked && !hit && meets(test, child) ? 1u << slot : 0u;
            inner |= is_leaf(child.w) ? 0u : bit;
            leaves |= is_leaf(child.w) ? bit : 0u;
        }
        ++walk.nodes;
        const uint any_lane = subgroupOr(inner << kWidth | leaves);
        uint any_leaf = any_lane & 0xffu;
        if (any_leaf != 0) {
            uint triangle = 0, last = 0, slot = 0;
            while (true) {
                if (triangle == last) {
                    if (any_leaf == 0) break;
                    slot = findLSB(any_leaf);
                    any_leaf &= any_leaf - 1u;
                    const uint link = subgroupShuffle(loaded.w, slot);
                    triangle = leaf_first(link);
                    last = triangle + leaf_count(link);
                }
                walk.steps -= min(walk.steps, 1u);
                ++walk.triangles;
                const CornerTriangle t = push.triangles.at[triangle++];
                if (has_bit(leaves, slot) && !hit && t.primitive != own_primitive) {
                    const int answer = leaf_occludes(segment, t.a, t.b, t.c);
                    hit = answer == 1;
                    unsure = unsure || answer == kUnsure;
                }
            }
            if (!subgroupAny(asked && !hit)) break;
        }
        const uint any_inner = any_lane >> kWidth;
        if (any_inner != 0) {
            if ((entry & 0xffu) != 0) {
                if (stack_depth >= stack_capacity()) {
                    walk.end = kEndStackFull;
                    break;
                }
                stack_push(entry);
            }
            entry = subgroupShuffle(loaded.w, 0) << 8 | any_inner;
        }
    }
    return hit;
}

struct PacketAnswer {
    uint occluded;    // slots
    uint deferred;    // slots without an answer
    uint stack_full;  // traversals given up because their stack was full
    uint step_limit;  // and because they took too many steps
};

// Answers `slots` of a tile, a packet at a time. `steps` are those that each traversal may take;
// `cost` is what the tile's points have cost before.
PacketAnswer answer_packets(uint tile, uint slots, inout uint steps, PointCost cost) {
    PacketAnswer answer = PacketAnswer(0, 0, 0, 0);
    for (uint k = 0; k < kSlots; ++k) {
        const bool asked = has_bit(slots, k);
        BvhWalk walk = bvh_walk_begin(steps);
        if (subgroupAny(asked)) {
            const uint point = tile_point(tile, k);
            bool unsure;
            const bool hit =
                packet_occluded(segment_of(point), primitive_of(point), asked, walk, unsure);
            if (hit && asked) answer.occluded |= 1u << k;
            if (!hit && asked && (unsure || walk.end != kEndFinished)) answer.deferred |= 1u << k;
            answer.stack_full += walk.end == kEndStackFull ? 1 : 0;
            answer.step_limit += walk.end == kEndStepLimit ? 1 : 0;
            steps = steps_after(walk.steps);
        }
        if (kStatistics)
            push.costs.at[tile_point(tile, k)] =
                PointCost(cost.nodes + walk.nodes, cost.triangles + walk.triangles);
    }
    return answer;
}

#endif
