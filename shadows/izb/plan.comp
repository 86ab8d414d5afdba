// Workgroups for the dispatch over list job.x, whose capacity is job.y: one for each job.z items, but
// at most job.w. None if the list has overflowed; the pass will be repeated.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

const uint kRowGroups = 32768u;  // of one dimension of a dispatch

void main() {
    if (workgroup() > 0 || lane() > 0) return;
    const uint count = push.status.at.counts[push.job.x];
    const uint items = count > push.job.y ? 0u : count;
    const uint groups = min((items + push.job.z - 1u) / push.job.z, push.job.w);
    const uint rows = (groups + kRowGroups - 1u) / kRowGroups;
    push.status.at.groups[push.job.x] = uvec3(min(groups, kRowGroups), rows, 1);
}
