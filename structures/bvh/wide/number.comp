// Step 3, per level: numbers the next level's nodes in the order of their parents, so that the tree
// does not depend on who ran first. One workgroup: a scan over the chunks' counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "structures/bvh/wide/build.glsl"

void main() {
    const WideLevel level = push.levels.at[push.level];
    const uint chunks = (level.end - level.begin + kChunk - 1) / kChunk;
    uint next = level.end;
    for (uint base = 0; base < chunks; base += gl_SubgroupSize) {
        const uint chunk = base + gl_SubgroupInvocationID;
        const uint inner = chunk < chunks ? push.chunk_offsets.at[chunk] : 0;
        const uint offset = subgroupExclusiveAdd(inner);
        if (chunk < chunks) push.chunk_offsets.at[chunk] = next + offset;
        next += subgroupAdd(inner);
    }
    if (gl_SubgroupInvocationID != 0) return;
    const uint count = next - level.end;
    const uint groups = min((count + kChunk - 1) / kChunk, kMaxGroups);
    push.levels.at[push.level + 1] = WideLevel(groups, 1, 1, level.end, next);
    push.header.header.pending = count;
    push.header.header.node_count = next;
    if (level.end > level.begin) push.header.header.depth += 1;
}
