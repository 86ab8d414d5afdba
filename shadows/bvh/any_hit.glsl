// Any-hit query of a wide BVH, one segment per lane.
//
// The hook of shadows/tiles/lanes.glsl. Each stack entry is a node's inner children that are still to be
// visited, so that the stack is no deeper than the tree.
#ifndef SHADOWS_BVH_ANY_HIT_GLSL
#define SHADOWS_BVH_ANY_HIT_GLSL
#include "shadows/bvh/leaf_variants.glsl"
#include "shadows/tiles/lanes.glsl"

const uint kLaneStack = 32u;

// The segment against boxes on the grid: t = scale * bound + offset per axis, where the bound that
// is met first is the lower (shift 0) or the upper (shift 16) half of the word.
struct SlabTest {
    vec3 scale;
    vec3 near_offset;
    vec3 far_offset;
    uvec3 near_shift;
    float t_end;  // 1 at the light
};

SlabTest slab_test(WideHeader header, Segment s) {
    const vec3 d = s.directional ? s.target : s.target - s.origin;
    const vec3 size = abs(d);
    // A direction of 0 becomes so small a one that the segment stays within the boxes' slack.
    const float least = max(max(size.x, size.y), size.z) * 1e-10;
    const vec3 inverse =
        mix(1.0 / d, mix(vec3(1.0 / least), vec3(-1.0 / least), lessThan(d, vec3(0))),
            lessThan(size, vec3(least)));
    const Grid grid = grid_from(header, s.origin, size.x + size.y + size.z);
    const bvec3 backward = lessThan(inverse, vec3(0));
    SlabTest test;
    test.scale = grid.cell * inverse;
    test.near_offset = mix(grid.base_lower, grid.base_upper, backward) * inverse;
    test.far_offset = mix(grid.base_upper, grid.base_lower, backward) * inverse;
    test.near_shift = mix(uvec3(0), uvec3(16), backward);
    test.t_end = s.directional ? 3.4e38 : 1.0;
    return test;
}

bool meets(SlabTest test, uvec4 child) {
    const vec3 near_bound = vec3((child.xyz >> test.near_shift) & 0xffffu);
    const vec3 far_bound = vec3((child.xyz >> (16u - test.near_shift)) & 0xffffu);
    const vec3 enter = near_bound * test.scale + test.near_offset;
    const vec3 leave = far_bound * test.scale + test.far_offset;
    const float first = max(max(enter.x, enter.y), max(enter.z, 0.0));
    const float last = min(min(leave.x, leave.y), min(leave.z, test.t_end));
    return first <= last && child.w != kEmptyLink;
}

bool lane_occluded(Segment segment, uint own_primitive, bool last_resort, inout Walk walk) {
    const WideHeader header = push.structure.header.header;
    if (header.node_count == 0) return false;
    const SlabTest test = slab_test(header, segment);
    uint stack[kLaneStack];
    uint depth = 0;
    uint entry = 1u;  // the root as the only child of a node that starts at 0
    bool hit = false, unsure = false;
    while (true) {
        if ((entry & 0xffu) == 0) {
            if (depth == 0) break;
            entry = stack[--depth];
        }
        if (walk.steps == 0) {
            walk.end = kEndStepLimit;
            break;
        }
        --walk.steps;
        const uint node = (entry >> 8) + findLSB(entry & 0xffu);
        entry &= entry - 1u;
        uint inner = 0, leaves = 0, base = 0;
        [[unroll]] for (uint slot = 0; slot < kWidth; ++slot) {
            const uvec4 child = push.structure.nodes.at[node * kWidth + slot];
            if (slot == 0) base = child.w;
            const uint bit = meets(test, child) ? 1u << slot : 0u;
            inner |= is_leaf(child.w) ? 0u : bit;
            leaves |= is_leaf(child.w) ? bit : 0u;
        }
        ++walk.nodes;
        if (leaves != 0) {
            uint triangle = 0, last = 0;
            while (true) {
                if (triangle == last) {
                    if (leaves == 0) break;
                    const uint link = push.structure.nodes.at[node * kWidth + findLSB(leaves)].w;
                    leaves &= leaves - 1u;
                    triangle = leaf_first(link);
                    last = triangle + leaf_count(link);
                }
                // Lanes may loop in turns.
                const uint loops = kLoopsAreCut ? kLanes * take_exact_loops() : 0u;
                walk.steps -= min(walk.steps, 1u + loops);
                ++walk.triangles;
                const CornerTriangle t = push.structure.triangles.at[triangle++];
                if (t.primitive != own_primitive) {
                    const int answer = leaf_occludes(segment, t.a, t.b, t.c);
                    hit = answer == 1;
                    if (answer == kUnsure) {
                        if (last_resort)
                            hit = occludes_exactly(segment, t.a, t.b, t.c);
                        else
                            unsure = true;
                    }
                    if (hit) break;
                }
            }
            if (hit) break;
        }
        if (inner != 0) {
            if ((entry & 0xffu) != 0) {
                if (depth >= min(kStackLimit, kLaneStack)) {
                    walk.end = kEndStackFull;
                    break;
                }
                stack[depth++] = entry;
            }
            entry = base << 8 | inner;
        }
    }
    if (!hit && unsure && walk.end == kEndFinished) walk.end = kEndUnsure;
    return hit;
}

#endif
