// Beam query: one subgroup answers a tile of points by walking a structure with groups of them.
//
//     #include "shadows/beam/beam.glsl"
//     layout(...) ...                              // the structure's parameters
//     vec3 beam_point(uint point) { ... }          // hooks: world position, primitive id,
//     uint beam_primitive(uint point) { ... }
//     CornerTriangle beam_triangle(uint index) { ... }
//     void beam_walk() { ... beam_meets_box(...); beam_test_triangles(...); }
//     void main() { beam_light = ...; TileAnswer answer = answer_tile(tile, origin, size); ... }
//
// A tile's points fall into groups (group.glsl): similar directions from the light. The structure's
// walk finds triangles that may occlude a group; those are culled against the beam, then tested
// against the points (candidate.glsl). Everything conservative only decides what to skip; points it
// cannot decide go to the exact test. Beams pay while many points ask about few triangles: a group
// that meets too many for its points, or whose walk runs out of stack or steps, is left to the
// caller, who must answer its points another way.
//
// The includer defines kDirectional, kLoopsAreCut, kStepLimit, kTrianglesPerPoint, and includes
// device.glsl first.
#ifndef SHADOWS_BEAM_BEAM_GLSL
#define SHADOWS_BEAM_BEAM_GLSL
#include "structures/geometry/corner_triangles.glsl"
#include "shadows/occlusion.glsl"

vec3 beam_light;  // position, or direction towards a directional light

#include "shadows/beam/points.glsl"
#include "shadows/beam/edges.glsl"
#include "shadows/beam/group.glsl"
#include "shadows/beam/candidate.glsl"

// Hooks.
vec3 beam_point(uint point);
uint beam_primitive(uint point);
CornerTriangle beam_triangle(uint index);
// Walks the structure with `beam`; stops early when group_finished() or out of steps.
void beam_walk();

const uint kBeamFinished = 0u, kBeamStackFull = 1u, kBeamStepLimit = 2u, kBeamDense = 3u;
// What setting up a group costs, in steps: visits of a node, batches of triangles, candidates.
const uint kGroupSteps = 8u;

struct TileAnswer {
    uint occluded;  // slots
    uint left;      // slots without an answer
    uint stack_full;  // groups given up because the stack was full
    uint groups;
    uint exact_tests;
};

// State of the tile under way; uniform over the subgroup except for the masks.
uint beam_tile;
uint beam_primitives;  // which hashes the primitives of its points have
uint beam_group;     // slots of the group
uint beam_occluded;  // slots found occluded, of any group
uint beam_unsure;    // slots with a triangle that double precision cannot tell
uint beam_steps;     // loop iterations so far
uint beam_live;      // sections with slots of the group that are not yet occluded
uint beam_end;       // why the walk of the group ended
uint beam_nodes, beam_triangles, beam_exact_tests;
uint beam_recent = 0xffffffffu;  // a triangle that has occluded a whole group, one per lane
uint beam_recent_count = 0;
uint beam_allowance;  // triangles that the group may still meet
bool beam_finished;  // every point of the group is occluded

bool group_finished() { return beam_finished; }

uint primitive_bit(uint primitive) { return 1u << (primitive * 2654435761u >> 27); }

// Limits the walk; false once the steps are used up.
bool beam_step(uint count) {
    beam_steps += count;
    if (beam_steps > kStepLimit) beam_end = kBeamStepLimit;
    return beam_end == kBeamFinished;
}

// Triangles about to be tested: false if they are more than the group may still meet.
bool beam_take_triangles(uint count) {
    beam_triangles += count;
    if (count > beam_allowance) beam_end = kBeamDense;
    beam_allowance -= min(count, beam_allowance);
    return beam_end == kBeamFinished;
}

// Exact test of one triangle against the lane's `slots`, not 0.
void test_exactly(uint index, uint slots) {
    const CornerTriangle t = beam_triangle(index);
    while (true) {
        const uint k = findLSB(slots);
        slots &= slots - 1u;
        const vec3 p = beam_point(tile_point(beam_tile, k));
        Segment segment;
        if (kDirectional)
            segment = directional_segment(p, beam_light);
        else
            segment = point_segment(p, beam_light);
        const int hit = occludes_quickly(segment, t.a, t.b, t.c);
        if (hit == 1) beam_occluded |= 1u << k;
        if (hit == kUnsure) beam_unsure |= 1u << k;
        ++beam_exact_tests;
        if (slots == 0) break;
    }
}

// Tests up to one triangle per lane against the group.
void beam_test_triangles(uint index, bool used) {
    Candidate mine;
    uint verdict = kMiss;
    if (used) {
        const CornerTriangle t = beam_triangle(index);
        verdict = classify(t.a, t.b, t.c, beam_live, mine);
        const bool receives = (primitive_bit(t.primitive) & beam_primitives) != 0;
        mine.receiver = receives ? t.primitive : kNoPrimitive;
        if (verdict == kCovers && receives) verdict = kMeets;
    }
    if (subgroupAny(verdict == kCovers)) {
        beam_occluded |= beam_group;
        beam_finished = true;
        const uint by =
            subgroupShuffle(index, subgroupBallotFindLSB(subgroupBallot(verdict == kCovers)));
        if (!subgroupAny(beam_recent == by)) {
            if (beam_recent_count % kLanes == lane()) beam_recent = by;
            ++beam_recent_count;
        }
        return;
    }
    uvec4 candidates = subgroupBallot(verdict == kMeets);
    if (candidates.xy == uvec2(0)) return;
    while (true) {
        const uint from = take_lane(candidates);
        ++beam_steps;
        uint hit, doubtful;
        const uint index_from = subgroupShuffle(index, from);
        test_points(broadcast(mine, from), hit, doubtful);
        beam_occluded |= hit & beam_group;
        doubtful &= beam_group & ~beam_occluded;
        // The loop of the exact tests counts for all lanes, or not at all.
        if (kLoopsAreCut && subgroupAny(doubtful != 0)) beam_steps += kSlots;
        if (doubtful != 0) test_exactly(index_from, doubtful);
        if (candidates.xy == uvec2(0)) break;
    }
    beam_live = live_sections(beam_group & ~beam_occluded);
    beam_finished = beam_live == 0;
}

// Answers one tile. `origin` is the light, or, for a directional light, a point near the scene;
// `size` is the order of distances from there.
TileAnswer answer_tile(uint tile, vec3 origin, float size) {
    beam_tile = tile;
    beam_origin = origin;
    beam_scale = scale_for(size);
    beam_occluded = beam_unsure = beam_steps = beam_nodes = beam_triangles = beam_exact_tests = 0;
    TileAnswer answer = TileAnswer(0, 0, 0, 0, 0);
    uint todo = 0, primitives = 0;
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const uint point = tile_point(tile, k);
        point_primitive[k] = beam_primitive(point);
        point_d[k] = (beam_point(point) - origin) * beam_scale;
        if (point_primitive[k] != kNoPrimitive) {
            primitives |= primitive_bit(point_primitive[k]);
            const vec3 size = abs(point_d[k]);
            if (kDirectional || max(max(size.x, size.y), size.z) > kTinyDistance)
                todo |= 1u << k;
            else
                answer.left |= 1u << k;
        }
    }
    beam_primitives = subgroupOr(primitives);
    // Guarded: drivers may run the body of a loop that has nothing to do.
    if (subgroupAny(todo != 0)) {
        while (true) {
            beam_end = kBeamFinished;
            beam_finished = false;
            beam_group = take_group(todo, beam_light);
            todo &= ~beam_group;
            beam_live = live_sections(beam_group);
            ++answer.groups;
            // What covered a tile lately may well cover this one.
            if (beam_recent_count > 0) beam_test_triangles(beam_recent, beam_recent != 0xffffffffu);
            beam_allowance =
                kTrianglesPerPoint * subgroupAdd(bitCount(beam_group & ~beam_occluded));
            if (beam_step(kGroupSteps) && !beam_finished) beam_walk();
            if (beam_end != kBeamFinished) {
                answer.left |= beam_group & ~beam_occluded;
                answer.stack_full += beam_end == kBeamStackFull ? 1 : 0;
            }
            if (!subgroupAny(todo != 0)) break;
            if (beam_steps > kStepLimit) {
                answer.left |= todo;
                break;
            }
        }
    }
    answer.occluded = beam_occluded;
    answer.left |= beam_unsure & ~beam_occluded;
    answer.exact_tests = beam_exact_tests;
    return answer;
}

#endif
