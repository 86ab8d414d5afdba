// A traversal stack shared by a subgroup, in the workgroup's scratch memory: entries are links.
#ifndef SHADOWS_METRIC_TREE_SHARED_STACK_GLSL
#define SHADOWS_METRIC_TREE_SHARED_STACK_GLSL

uint stack_depth;  // uniform

uint stack_capacity() { return min(kStackLimit, kScratchWords); }

/// Pushes the links of all lanes that `have` one; false if there is no room for all of them.
bool stack_push(bool have, uint link) {
    const uvec4 votes = subgroupBallot(have);
    const uint count = subgroupBallotBitCount(votes);
    if (stack_depth + count > stack_capacity()) return false;
    const uint place = stack_depth + subgroupBallotExclusiveBitCount(votes);
    if (have) push.scratch.at[gl_WorkGroupID.x * kScratchWords + place] = link;
    stack_depth += count;
    return true;
}

/// Takes up to one entry per lane off the stack, the topmost first; 0 for lanes without one.
uint stack_pop(uint most) {
    subgroup_sync();
    const uint count = min(stack_depth, most);
    stack_depth -= count;
    const uint place = stack_depth + count - 1 - lane();
    const uint link =
        lane() < count ? push.scratch.at[gl_WorkGroupID.x * kScratchWords + place] : 0;
    subgroup_sync();
    return link;
}

#endif
