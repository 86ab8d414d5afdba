// Walks the wide BVH with a beam: the structure's hook of shadows/beam/beam.glsl.
//
// Eight lanes test a node's eight children at once (wide subgroups: several nodes). Hits among the
// inner children become one stack entry, hits among the leaves append their triangles to a list,
// which is worked off when the stack is empty, or when it is full or too long for a beam.
#include "shadows/tiles/subgroup_stack.glsl"

const uint kNodesAtOnce = kLanes / kWidth;

// A node's children as bounds in the frame of the beam.
struct BeamGrid {
    vec3 lower, upper, cell;
};

BeamGrid beam_grid() {
    const Grid grid = grid_from(push.structure.header.header, beam_origin, beam.reach / beam_scale);
    BeamGrid g;
    const vec3 p = to_beam(grid.base_lower * beam_scale), q = to_beam(grid.base_upper * beam_scale);
    g.cell = to_beam(grid.cell * beam_scale);
    // Mirrored, the upper bound's base is the lower one.
    g.lower = vec3(p.xy, beam.mirror > 0 ? p.z : q.z);
    g.upper = vec3(q.xy, beam.mirror > 0 ? q.z : p.z);
    return g;
}

bool meets_child(BeamGrid grid, uvec4 child) {
    uvec3 bits = beam.axis == 0 ? child.yzx : beam.axis == 1 ? child.zxy : child.xyz;
    if (beam.mirror < 0) bits.z = bits.z << 16 | bits.z >> 16;
    const vec3 lower = grid.lower + grid.cell * vec3(bits & 0xffffu);
    const vec3 upper = grid.upper + grid.cell * vec3(bits >> 16);
    return beam_meets_box(lower, upper);
}

// What the lanes found at their children, known to all.
struct ChildVote {
    uvec2 inner;  // lanes with an inner child to visit
    uint before;  // triangles of the leaves in lower lanes
    uint total;   // and in all
};

// Sum of eight counts of 3 bits.
uint sum_counts(uint counts) {
    const uint pairs = (counts & 0x1c71c7u) + (counts >> 3 & 0x1c71c7u);
    return (pairs * 0x41041u >> 18) & 63u;
}

ChildVote vote_children(bool inner, uint triangles) {
    ChildVote vote;
    if (kLanes == 8) {
        // One vote for everything: counts fit 3 bits each.
        const uint word = subgroupOr(triangles << (3 * lane()) | (inner ? 1u << (24 + lane()) : 0u));
        vote.inner = uvec2(word >> 24, 0);
        vote.before = sum_counts(word & ((1u << (3 * lane())) - 1u));
        vote.total = sum_counts(word & 0xffffffu);
    } else {
        vote.inner = subgroupBallot(inner).xy;
        vote.before = subgroupExclusiveAdd(triangles);
        vote.total = subgroupAdd(triangles);
    }
    return vote;
}

CornerTriangle beam_triangle(uint index) { return corner_triangle(push.structure.triangles, index); }

void process_list(uint list, uint count) {
    subgroup_sync();
    if (count == 0 || !beam_take_triangles(count)) return;
    uint i = 0;
    while (true) {
        const bool used = i + lane() < count;
        beam_test_triangles(used ? push.scratch.at[list + i + lane()] : 0, used);
        i += kLanes;
        if (i >= count || group_finished() || !beam_step(1)) break;
    }
    subgroup_sync();
}

void beam_walk() {
    if (push.structure.header.header.node_count == 0) return;
    const BeamGrid grid = beam_grid();
    const uint list = gl_WorkGroupID.x * kScratchWords;
    const uint list_full = min(kScratchWords - kMaxLeafCount * kLanes, beam_allowance);
    uint list_count = 0;
    uint entry = 1u;  // the root as the only child of a node that starts at 0
    stack_depth = 0;
    while (true) {
        // The next nodes: lane l gets child l % 8 of node l / 8.
        uint node = 0xffffffffu;
        [[unroll]] for (uint g = 0; g < kNodesAtOnce; ++g) {
            if ((entry & 0xffu) == 0 && stack_depth > 0) entry = stack_pop();
            if ((entry & 0xffu) != 0) {
                if (lane() / kWidth == g) node = (entry >> 8) + findLSB(entry & 0xffu);
                entry &= entry - 1u;
                ++beam_nodes;
            }
        }
        uint link = kEmptyLink;
        bool hit = false;
        if (node != 0xffffffffu) {
            const uvec4 child = push.structure.nodes.at[node * kWidth + lane() % kWidth];
            link = child.w;
            hit = link != kEmptyLink && meets_child(grid, child);
        }
        const bool leaf = is_leaf(link);
        const uint triangles = hit && leaf ? leaf_count(link) : 0;
        const ChildVote vote = vote_children(hit && !leaf, triangles);
        [[unroll]] for (uint i = 0; i < kMaxLeafCount; ++i)
            if (i < triangles) push.scratch.at[list + list_count + vote.before + i] = leaf_first(link) + i;
        list_count += vote.total;
        [[unroll]] for (uint g = 0; g < kNodesAtOnce; ++g) {
            const uint mask = (g < 4 ? vote.inner.x >> (8 * g) : vote.inner.y >> (8 * g - 32)) & 0xffu;
            if (mask == 0) continue;
            if ((entry & 0xffu) != 0) {
                if (stack_depth >= stack_capacity()) {
                    beam_end = kBeamStackFull;
                    break;
                }
                stack_push(entry);
            }
            entry = subgroupShuffle(link, g * kWidth) << 8 | mask;
        }
        const bool done = (entry & 0xffu) == 0 && stack_depth == 0;
        if (done || list_count > list_full) {
            process_list(list, list_count);
            list_count = 0;
        }
        if (done || group_finished() || beam_end != kBeamFinished || !beam_step(1)) break;
    }
}
