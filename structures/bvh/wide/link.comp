// Step 4, per level: boxes onto the grid, links into the next level, and the next level's items.
// Eight lanes per node, one for each child.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "structures/bvh/wide/build.glsl"

uint grid_bounds(float lower, float upper, float origin, float cell) {
    const float low = floor((lower - origin) / cell - kGridMargin);
    const float high = ceil((upper - origin) / cell + kGridMargin);
    return uint(clamp(low, 0.0, 65535.0)) | uint(clamp(high, 0.0, 65535.0)) << 16;
}

void main() {
    const WideLevel level = push.levels.at[push.level];
    const uint chunks = (level.end - level.begin + kChunk - 1) / kChunk;
    const vec3 origin = push.header.header.origin, cell = push.header.header.cell;
    const uint slot = gl_SubgroupInvocationID % kWidth;
    const uint nodes_at_once = gl_SubgroupSize / kWidth;
    for (uint chunk = gl_WorkGroupID.x; chunk < chunks; chunk += gl_NumWorkGroups.x) {
        uint next = push.chunk_offsets.at[chunk];
        for (uint i = 0; i < kChunk; i += nodes_at_once) {
            const uint id = level.begin + chunk * kChunk + i + gl_SubgroupInvocationID / kWidth;
            uvec4 child = uvec4(0, 0, 0, kKindEmpty);
            if (id < level.end) child = push.nodes.at[id * kWidth + slot];
            const bool inner = child.w == kKindInner;
            const uvec4 vote = subgroupBallot(inner);
            // Inner children are numbered by lane: nodes in order, slots in order.
            const uint number = next + subgroupBallotExclusiveBitCount(vote);
            next += subgroupBallotBitCount(vote);
            if (inner) push.items.at[number] = WideItem(child.x, child.y, child.z);
            if (id < level.end) {
                uvec4 packed = uvec4(0xffffu, 0xffffu, 0xffffu, kEmptyLink);
                if (child.w != kKindEmpty) {
                    const BvhNode node = push.binary.at[child.x];
                    packed.x = grid_bounds(node.lower.x, node.upper.x, origin.x, cell.x);
                    packed.y = grid_bounds(node.lower.y, node.upper.y, origin.y, cell.y);
                    packed.z = grid_bounds(node.lower.z, node.upper.z, origin.z, cell.z);
                    packed.w = inner ? number
                                     : kLeafBit | child.z << kLeafCountShift | child.y;
                }
                push.nodes.at[id * kWidth + slot] = packed;
            }
        }
    }
}
