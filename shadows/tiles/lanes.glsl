// One segment per lane: the query itself, and the last word on points that other queries left over.
// Hook:
//     bool lane_occluded(Segment s, uint own_primitive, bool last_resort, inout Walk walk)
// With `last_resort`, whatever it takes; without, a walk that hits nothing ends as kEndUnsure if it has
// met a triangle that double precision cannot tell.
#ifndef SHADOWS_TILES_LANES_GLSL
#define SHADOWS_TILES_LANES_GLSL

bool lane_occluded(Segment segment, uint own_primitive, bool last_resort, inout Walk walk);

void answer_by_lanes() {
    uint taken = 0, stack_full = 0, step_limit = 0, steps = kStepLimit;
    while (true) {
        const uint tile = next_tile(taken);
        if (tile == kNoTile) break;
        uint occluded = 0, deferred = 0;
        for (uint k = 0; k < kSlots; ++k) {
            const uint point = tile_point(tile, k);
            const uint primitive = primitive_of(point);
            Walk walk = walk_begin(steps);
            if (primitive != kNoPrimitive) {
                if (lane_occluded(segment_of(point), primitive, false, walk)) occluded |= 1u << k;
                if (walk.end != kEndFinished) deferred |= 1u << k;
                stack_full += walk.end == kEndStackFull ? 1 : 0;
                step_limit += walk.end == kEndStepLimit ? 1 : 0;
            }
            steps = steps_after(walk.steps);
            if (kStatistics) push.costs.at[point] = PointCost(walk.nodes, walk.triangles);
        }
        store_tile(push.visible, tile, ~occluded);
        defer(tile, deferred);
    }
    count_decisions();
    if (stack_full > 0) atomicAdd(push.status.at.stack_full, stack_full);
    if (step_limit > 0) atomicAdd(push.status.at.step_limit, step_limit);
}

// One segment per lane and invocation, so that each has all of an invocation's steps. Workgroup (x, y)
// takes slot y of the x-th tile with such points.
void answer_deferred() {
    const uint point = tile_point(push.tiles.at[gl_WorkGroupID.x], gl_WorkGroupID.y);
    const uint word = point / 32, bit = 1u << (point % 32);
    if ((push.deferred.at[word] & bit) == 0) return;
    Walk walk = walk_begin(kStepLimit);
    if (lane_occluded(segment_of(point), primitive_of(point), true, walk))
        atomicAnd(push.visible.at[word], ~bit);
    else if (walk.end != kEndFinished)
        atomicAdd(push.status.at.incomplete, 1u);
    count_decisions();
    if (kStatistics) {
        push.costs.at[point].nodes += walk.nodes;
        push.costs.at[point].triangles += walk.triangles;
    }
}

#endif
