// Testing the points of cells against a triangle: what the kernels over entries and over ranges of
// points share. A lane holds an entry; the subgroup turns to them one after the other. What double
// precision cannot tell goes to a list with room for job.x pairs.
#ifndef SHADOWS_IZB_TEST_GLSL
#define SHADOWS_IZB_TEST_GLSL
#include "shadows/izb/caster.glsl"

// What a lane knows of its entry.
struct Held {
    bool used;
    uint index;
    uint face;
    uvec2 first, last;
    CornerTriangle triangle;
    Caster caster;
};

// The entry at hand, the same in all lanes.
uint entry_index, entry_face;
uvec2 entry_first, entry_last;
CornerTriangle entry_triangle;
Caster entry_caster;

uint batches_left;  // of points that this invocation may still test
uint test_count, exact_count;

Held hold(uint index, bool used, vec3 origin, float scale, vec2 tilt) {
    Held held;
    held.used = used;
    held.index = index;
    held.face = 0;
    if (used) {
        const IzbEntry entry = push.entries.at[index];
        held.face = entry.caster >> kFaceShift;
        held.first = uvec2(entry.lower & 0xffffu, entry.lower >> 16);
        held.last = uvec2(entry.upper & 0xffffu, entry.upper >> 16);
        held.triangle = corner_triangle(push.triangles, entry.caster & kCasterMask);
        held.caster = make_caster(corners_of(held.triangle, origin, scale, held.face), tilt,
                                  cells_rectangle(held.face, held.first, held.last), entry.reach);
    }
    return held;
}

void turn_to(Held held, uint from) {
    entry_index = subgroupShuffle(held.index, from);
    entry_face = subgroupShuffle(held.face, from);
    entry_first = subgroupShuffle(held.first, from);
    entry_last = subgroupShuffle(held.last, from);
    entry_triangle.a = subgroupShuffle(held.triangle.a, from);
    entry_triangle.b = subgroupShuffle(held.triangle.b, from);
    entry_triangle.c = subgroupShuffle(held.triangle.c, from);
    entry_triangle.primitive = subgroupShuffle(held.triangle.primitive, from);
    entry_caster = broadcast(held.caster, from);
}

// Leaves a point to unsure.comp, against the entry at hand. A list that has overflowed is not
// counted further, lest the count wraps.
void leave_unsure(uint place) {
    uint index = push.status.at.counts[kUnsurePairs];
    if (index <= push.job.x) index = atomicAdd(push.status.at.counts[kUnsurePairs], 1u);
    if (index >= push.job.x) return;
    push.keys.at[2 * index] = entry_index;
    push.keys.at[2 * index + 1] = place;
}

// Tests the points at places [begin, end), which is not empty. Returns the smallest k of those that
// are not shadowed, of this lane's. Subgroups may do this to the same points at the same time: a
// primitive is overwritten at most by kNoPrimitive, so whichever value is read is right.
float test_points(uint begin, uint end) {
    float farthest = kHuge;
    uint first = begin;
    while (true) {
        const uint place = first + lane();
        uint verdict = kMiss;
        IzbPoint p = IzbPoint(0, 0, kHuge, kNoPrimitive);
        if (place < end) p = push.binned.at[place];
        const bool alive = p.primitive != kNoPrimitive;
        if (alive && p.primitive != entry_triangle.primitive)
            verdict = classify(entry_caster, p.u, p.v, p.k);
        if (kStatistics) {
            test_count += alive ? 1 : 0;
            exact_count += verdict == kDoubt ? 1 : 0;
        }
        if (verdict == kDoubt) {
            const int answer = occludes_quickly(segment_of(place), entry_triangle.a,
                                                entry_triangle.b, entry_triangle.c);
            if (answer == kUnsure) leave_unsure(place);
            verdict = answer == 1 ? kHit : kMiss;
        }
        if (verdict == kHit) push.binned.at[place].primitive = kNoPrimitive;
        if (alive && verdict != kHit) farthest = min(farthest, p.k);
        first += gl_SubgroupSize;
        if (first >= end) break;
    }
    return farthest;
}

void add_statistics() {
    if (!kStatistics) return;
    const uint tests = subgroupAdd(test_count), exact = subgroupAdd(exact_count);
    if (lane() == 0) {
        if (atomicAdd(push.status.at.tests.x, tests) > ~tests)
            atomicAdd(push.status.at.tests.y, 1u);
        if (atomicAdd(push.status.at.exact_tests.x, exact) > ~exact)
            atomicAdd(push.status.at.exact_tests.y, 1u);
    }
}

#endif
