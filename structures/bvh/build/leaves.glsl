// Full SAH over a range that fits a subgroup: each lane holds one primitive, all open segments of the
// range are split at once, until every one is a leaf (paper, section 4.1: subtrees of at most one
// warp, by shuffles). Primitives stay in their lanes: a segment is a set of lanes.

layout(constant_id = 18) const uint kMaxLeaf = 4;
layout(constant_id = 19) const bool kLeafByCost = true;
layout(constant_id = 20) const float kTraversalCost = 3;
layout(constant_id = 21) const float kIntersectionCost = 2;

/// A split "centres up to lane's go left": `place` is axis * 32 + lane, and the lowest wins a tie.
struct Candidate {
    float cost;
    uint place;
};

/// The cheapest of this lane's three splits of its segment `members`; `box` becomes the segment's box.
Candidate candidate_split(uint members, KeyBox mine, vec3 center, uint lanes, out KeyBox box) {
    KeyBox left[3] = KeyBox[](empty_keys(), empty_keys(), empty_keys());
    KeyBox right[3] = left;
    uvec3 left_count = uvec3(0);
    for (uint lane = 0; lane < lanes; ++lane) {
        const KeyBox other = KeyBox(subgroupShuffle(mine.low, lane), subgroupShuffle(mine.high, lane));
        const vec3 place = subgroupShuffle(center, lane);
        const uint same = (members >> lane & 1) != 0 ? 0xffffffffu : 0;
        const bool first = lane <= gl_SubgroupInvocationID;
        [[unroll]] for (uint axis = 0; axis < 3; ++axis) {
            const uint lefts = place[axis] < center[axis] || (place[axis] == center[axis] && first)
                                   ? same : 0;
            left[axis] = join(left[axis], masked(lefts, other));
            right[axis] = join(right[axis], masked(same ^ lefts, other));
            left_count[axis] += lefts & 1;
        }
    }
    box = join(left[0], right[0]);
    const uint count = uint(bitCount(members));
    Candidate best = Candidate(kInfinity, kNone);
    [[unroll]] for (uint axis = 0; axis < 3; ++axis) {
        const uint right_count = count - left_count[axis];
        precise float cost = half_area(left[axis]) * float(left_count[axis]) +
                             half_area(right[axis]) * float(right_count);
        if (right_count > 0 && cost < best.cost)
            best = Candidate(cost, axis * 32 + gl_SubgroupInvocationID);
    }
    return best;
}

/// The cheapest candidate of a segment's lanes.
Candidate best_of(uint members, Candidate mine, uint lanes) {
    Candidate best = Candidate(kInfinity, kNone);
    for (uint lane = 0; lane < lanes; ++lane) {
        const float cost = subgroupShuffle(mine.cost, lane);
        const uint place = subgroupShuffle(mine.place, lane);
        if ((members >> lane & 1) != 0 &&
            (cost < best.cost || (cost == best.cost && place < best.place)))
            best = Candidate(cost, place);
    }
    return best;
}

void build_leaves(Task task) {
    const uint lane = gl_SubgroupInvocationID;
    const bool used = lane < task.count;
    const Primitive primitive =
        primitives_of(task.side).at[task.first + min(lane, task.count - 1)];
    const KeyBox keys = keys_of(primitive.lower, primitive.upper);
    precise vec3 center = primitive.lower + primitive.upper;
    const uint lanes_before = (1u << (lane & 31)) - 1;
    // This lane's segment: its lanes, where its range begins, and its node.
    uint members = used ? 0xffffffffu >> (32 - task.count) : 0;
    uint begin = task.first, node = task.node;
    bool open = used;

    while (subgroupAny(open)) {
        KeyBox box;
        const Candidate mine = candidate_split(members, keys, center, task.count, box);
        const Candidate best = best_of(members, mine, task.count);
        const uint count = uint(bitCount(members)), before = uint(bitCount(members & lanes_before));
        precise float leaf_cost = kIntersectionCost * float(count) * half_area(box);
        precise float split_cost = kTraversalCost * half_area(box) + kIntersectionCost * best.cost;
        const bool leaf = count == 1 || (count <= kMaxLeaf && (!kLeafByCost || leaf_cost <= split_cost));
        // Boxes whose areas overflow leave no finite cost: halve by position then.
        const bool halve = best.place == kNone;
        const uint axis = halve ? 0 : best.place / 32, at = halve ? 0 : best.place % 32;
        const float value = axis == 0 ? center.x : axis == 1 ? center.y : center.z;
        // Lane `at` is in this lane's segment, so it offers its centre on the same axis.
        const float plane = subgroupShuffle(value, at);
        const bool goes_left = open && !leaf && (halve ? before < count / 2
                                                       : value < plane || (value == plane && lane <= at));
        const uint lefts = members & subgroupBallot(goes_left).x;
        const uint pair = 2 * (begin + uint(bitCount(lefts))) - 1;
        if (open && before == 0)
            pool.client.nodes.at[node] =
                BvhNode(lower_of(box), leaf ? begin : pair, upper_of(box), leaf ? count : 0);
        open = open && !leaf;
        if (open) {
            members = goes_left ? lefts : members & ~lefts;
            node = goes_left ? pair : pair + 1;
            begin += goes_left ? 0 : uint(bitCount(lefts));
        }
        pool_spend(2 * task.count + 4);
    }
    if (used) pool.client.order.at[begin + uint(bitCount(members & lanes_before))] = primitive.id;
}
