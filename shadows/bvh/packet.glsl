// Any-hit query of a wide BVH, a packet of segments with one stack: the hook of
// shadows/tiles/packets.glsl. Lanes load a node's children once and pass them round.
#ifndef SHADOWS_BVH_PACKET_GLSL
#define SHADOWS_BVH_PACKET_GLSL
#include "shadows/bvh/any_hit.glsl"
#include "shadows/tiles/packets.glsl"
#include "shadows/tiles/subgroup_stack.glsl"

bool packet_occluded(Segment segment, uint own_primitive, bool asked, inout Walk walk,
                     out bool unsure) {
    const WideHeader header = push.structure.header.header;
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
        const uvec4 loaded = push.structure.nodes.at[node * kWidth + lane() % kWidth];
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
                const CornerTriangle t = push.structure.triangles.at[triangle++];
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

#endif
