// All that is below a range of as many elements as a subgroup has lanes, or fewer: each lane holds one
// element, a segment is a set of lanes, and all segments are split at once until none is left. Every
// element is tried as its segment's pivot, against all others.

/// The lane of the best pivot among the segment's lanes; of equal ones, the lowest.
uint best_lane(uint members, float merit, uint lanes) {
    float best = -kInfinity;
    uint at = gl_SubgroupInvocationID;
    bool found = false;
    for (uint lane = 0; lane < lanes; ++lane) {
        const float other = subgroupShuffle(merit, lane);
        if ((members >> lane & 1) != 0 && (!found || other > best)) {
            best = other;
            at = lane;
            found = true;
        }
    }
    return at;
}

void build_leaf(Range range) {
    const uint lane = gl_SubgroupInvocationID, row = min(lane, kLeafRange - 1) * kLeafRange;
    bool open = lane < range.count;
    const uint id = id_at(range.side, range.first + min(lane, range.count - 1));
    const Element element = element_of(id);
    const float min_depth = pool.client.nodes.at[id].min_depth;
    // This lane's segment: its lanes, and what a range has.
    uint members = open ? (1u << range.count) - 1 : 0;
    uint owner = range.owner, ancestor = range.ancestor, depth = range.depth;

    while (subgroupAny(open)) {
        Bounds bounds = no_bounds();
        uint others = 0;
        for (uint other = 0; other < range.count; ++other) {
            const Element its = Element(subgroupShuffle(element.a, other),
                                        subgroupShuffle(element.b, other),
                                        subgroupShuffle(element.radius, other));
            const float its_depth = subgroupShuffle(min_depth, other);
            if ((members >> other & 1) != 0) {
                bounds.min_depth = min(bounds.min_depth, its_depth);
                if (other != lane) reaches[row + others++] = reach_between(element, its);
            }
        }
        const Choice choice = best_delta(row, others, 0, 1);
        const float merit = -cost_of(row, others, choice.delta);
        const uint pivot = best_lane(members, merit, range.count);

        uint parts[3] = uint[](0, 0, 0);
        uint k = 0;
        for (uint other = 0; other < range.count; ++other)
            if ((members >> other & 1) != 0 && other != lane) {
                const vec3 reach = reaches[row + k++];
                const uint part = part_of(reach, choice.delta);
                take_in(bounds, reach, part);
                parts[part] |= 1u << other;
            }
        if (open && pivot == lane) write_node(id, bounds, owner, ancestor);

        const uint node = subgroupShuffle(id, pivot);
        const uint near = subgroupShuffle(parts[kNear], pivot), far = subgroupShuffle(parts[kFar], pivot),
                   over = subgroupShuffle(parts[kOver], pivot);
        open = open && pivot != lane;
        if (open) {
            const uint part = (near >> lane & 1) != 0 ? kNear : (far >> lane & 1) != 0 ? kFar : kOver;
            members = part == kNear ? near : part == kFar ? far : over;
            owner = 4 * node + part;
            if (part == kOver) ancestor = node + 1;
            ++depth;
        } else {
            members = 0;
        }
        pool_spend(5 * (range.count + 1) + kTurnIterations + choice_iterations(lane_max(others), 1));
    }
    reach_depth(lane_max(lane < range.count ? depth : 0));
    pool_progress(range.count);
}
