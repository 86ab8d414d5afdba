// Step 2, per level: each waiting node becomes up to eight children. Starting from the two children
// of its binary node, the child with the largest surface is replaced by its own two until there are
// eight or none is left to open (Wald, Benthin and Boulos 2008, "Getting rid of packets",
// section 3.2). A leaf of more than kMaxLeafCount triangles counts as a subtree of its halves, all
// with the leaf's box. One lane per node; its children live in registers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "structures/bvh/wide/build.glsl"

WideItem child[kWidth];
float priority[kWidth];  // surface of what can be opened, -1 for what cannot

bool can_open(WideItem item) { return item.count == 0 || item.count > kMaxLeafCount; }

// An item of a binary node whose corners are known: surfaces order the opening, nothing else.
float priority_of(WideItem item, vec3 lower, vec3 upper) {
    if (!can_open(item)) return -1;
    const vec3 e = upper - lower;
    const float surface = e.x * e.y + e.y * e.z + e.z * e.x;
    return surface >= 0 ? surface : 0;
}

void set_child(uint slot, WideItem item, float item_priority) {
    [[unroll]] for (uint k = 0; k < kWidth; ++k) {
        if (k == slot) {
            child[k] = item;
            priority[k] = item_priority;
        }
    }
}

// Replaces the child in `slot` by its two halves, the second at the end.
void open_child(uint slot, WideItem item, inout uint count) {
    WideItem left, right;
    float left_priority, right_priority;
    if (item.count == 0) {
        const BvhNode a = push.binary.at[item.first], b = push.binary.at[item.first + 1];
        left = WideItem(item.first, a.first, a.count);
        right = WideItem(item.first + 1, b.first, b.count);
        left_priority = priority_of(left, a.lower, a.upper);
        right_priority = priority_of(right, b.lower, b.upper);
    } else {
        const BvhNode leaf = push.binary.at[item.node];
        const uint half_count = item.count / 2;
        left = WideItem(item.node, item.first, half_count);
        right = WideItem(item.node, item.first + half_count, item.count - half_count);
        left_priority = priority_of(left, leaf.lower, leaf.upper);
        right_priority = priority_of(right, leaf.lower, leaf.upper);
    }
    set_child(slot, left, left_priority);
    set_child(count, right, right_priority);
    ++count;
}

void main() {
    const WideLevel level = push.levels.at[push.level];
    const uint chunks = (level.end - level.begin + kChunk - 1) / kChunk;
    for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
        uint chunk_inner = 0;
        for (uint i = 0; i < kChunk; i += gl_SubgroupSize) {
            const uint id = level.begin + chunk * kChunk + i + gl_SubgroupInvocationID;
            uint inner = 0;
            if (id < level.end && i + gl_SubgroupInvocationID < kChunk) {
                const WideItem item = push.items.at[id];
                [[unroll]] for (uint k = 0; k < kWidth; ++k) priority[k] = -1;
                uint count = 1;
                set_child(0, item, -1);
                if (can_open(item)) open_child(0, item, count);
                for (uint round = 0; round < kWidth - 2; ++round) {
                    uint best = kWidth;
                    float best_priority = -1;
                    WideItem best_item = item;
                    [[unroll]] for (uint k = 0; k < kWidth; ++k) {
                        if (priority[k] > best_priority) {
                            best = k;
                            best_priority = priority[k];
                            best_item = child[k];
                        }
                    }
                    if (best < kWidth) open_child(best, best_item, count);
                }
                // Inner children first.
                [[unroll]] for (uint k = 0; k < kWidth; ++k) inner += priority[k] >= 0 ? 1 : 0;
                uint next_inner = 0, next_leaf = inner;
                [[unroll]] for (uint k = 0; k < kWidth; ++k) {
                    const bool opens = priority[k] >= 0;
                    const uint slot = k >= count ? k : opens ? next_inner++ : next_leaf++;
                    const uint kind = k >= count ? kKindEmpty : opens ? kKindInner : kKindLeaf;
                    push.nodes.at[id * kWidth + slot] =
                        uvec4(child[k].node, child[k].first, child[k].count, kind);
                }
            }
            chunk_inner += subgroupAdd(inner);
        }
        if (gl_SubgroupInvocationID == 0) push.chunk_offsets.at[chunk] = chunk_inner;
    }
}
