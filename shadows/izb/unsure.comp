// Decides the points that test.comp and ranges.comp left over, since double precision cannot: a
// pair of entry and point per lane, so that each invocation runs the loops of a single decision in
// error-free sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const uint index = workgroup() * gl_SubgroupSize + lane();
    if (index >= push.status.at.counts[kUnsurePairs]) return;
    const uint entry = push.keys.at[2 * index], place = push.keys.at[2 * index + 1];
    const uint caster = push.entries.at[entry].caster & kCasterMask;
    const CornerTriangle t = corner_triangle(push.triangles, caster);
    if (occludes_exactly(segment_of(place), t.a, t.b, t.c))
        push.binned.at[place].primitive = kNoPrimitive;
}
