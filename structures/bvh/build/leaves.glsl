// Full SAH over a range that fits a subgroup: each lane holds one primitive, all open segments of the
// range are split at once, until every one is a leaf (paper, section 4.1: subtrees of at most one
// warp, by shuffles).

layout(constant_id = 18) const uint kMaxLeaf = 4;
layout(constant_id = 19) const bool kLeafByCost = true;
layout(constant_id = 20) const float kTraversalCost = 3;
layout(constant_id = 21) const float kIntersectionCost = 2;

shared uint lane_words[8 * 64];  // one primitive per lane, for moving them

struct Candidate {
    float cost;
    uint place;  // axis * 64 + lane: the lowest wins a tie
};

/// The cheaper of this lane's three splits "all of my segment with a centre up to mine go left";
/// `box` becomes the segment's box.
Candidate candidate_split(uint begin, uint end, vec3 lower, vec3 upper, uint lanes, out KeyBox box) {
    precise vec3 center = lower + upper;
    KeyBox left[3] = KeyBox[](empty_keys(), empty_keys(), empty_keys());
    KeyBox right[3] = left;
    uvec3 left_count = uvec3(0);
    const KeyBox mine = keys_of(lower, upper);
    for (uint lane = 0; lane < lanes; ++lane) {
        const KeyBox other = KeyBox(subgroupShuffle(mine.low, lane), subgroupShuffle(mine.high, lane));
        const vec3 place = subgroupShuffle(center, lane);
        const bool same = lane >= begin && lane < end;
        const bool first = lane <= gl_SubgroupInvocationID;
        [[unroll]] for (uint axis = 0; axis < 3; ++axis) {
            const bool goes_left = place[axis] < center[axis] || (place[axis] == center[axis] && first);
            left[axis] = join(left[axis], keep_if(same && goes_left, other));
            right[axis] = join(right[axis], keep_if(same && !goes_left, other));
            left_count[axis] += same && goes_left ? 1 : 0;
        }
    }
    box = join(left[0], right[0]);
    Candidate best = Candidate(kInfinity, kNoPlane);
    [[unroll]] for (uint axis = 0; axis < 3; ++axis) {
        const uint right_count = end - begin - left_count[axis];
        precise float cost = half_area(left[axis]) * float(left_count[axis]) +
                             half_area(right[axis]) * float(right_count);
        if (right_count > 0 && cost < best.cost) best = Candidate(cost, axis * 64 + gl_SubgroupInvocationID);
    }
    return best;
}

void build_leaves(Task task) {
    const uint lane = gl_SubgroupInvocationID;
    const bool used = lane < task.count;
    const Primitive primitive = load_primitive(task.side, task.first + min(lane, task.count - 1));
    vec3 lower = primitive.lower, upper = primitive.upper;
    uint id = primitive.id;
    uint begin = used ? 0 : lane, end = used ? task.count : lane;  // this lane's segment
    uint node = task.node;
    bool open = used;

    while (subgroupAny(open)) {
        KeyBox box;
        const Candidate mine = candidate_split(begin, end, lower, upper, task.count, box);
        // The segment's best candidate, by looking at all lanes in turn.
        Candidate best = Candidate(kInfinity, kNoPlane);
        for (uint other = 0; other < task.count; ++other) {
            const float cost = subgroupShuffle(mine.cost, other);
            const uint place = subgroupShuffle(mine.place, other);
            if (other >= begin && other < end &&
                (cost < best.cost || (cost == best.cost && place < best.place)))
                best = Candidate(cost, place);
        }
        const uint count = end - begin;
        precise float leaf_cost = kIntersectionCost * float(count) * half_area(box);
        precise float split_cost = kTraversalCost * half_area(box) + kIntersectionCost * best.cost;
        const bool leaf = count == 1 || (count <= kMaxLeaf && (!kLeafByCost || leaf_cost <= split_cost));
        const bool splits = open && !leaf;
        // Boxes whose areas overflow leave no finite cost: halve by position then.
        const bool halve = best.place == kNoPlane;
        const uint axis = halve ? 0 : best.place / 64, at = halve ? 0 : best.place % 64;
        precise vec3 center = lower + upper;
        const float plane = subgroupShuffle(axis == 0 ? center.x : axis == 1 ? center.y : center.z, at);
        // (Each lane asks for its own segment's plane on its own segment's axis, but the value comes
        // from lane `at` under *that* lane's axis, which is the same: they share the segment.)
        const float value = center[axis];
        const bool goes_left = splits && (halve ? lane < begin + count / 2
                                                : value < plane || (value == plane && lane <= at));
        const uvec4 lefts = subgroupBallot(goes_left);
        const uint left_before = bits_between(lefts, begin, lane);
        const uint left_count = bits_between(lefts, begin, end);
        if (open && lane == begin) {
            const uint pair = 2 * (task.first + begin + left_count) - 1;
            pool.client.nodes.at[node] =
                BvhNode(lower_of(box), leaf ? task.first + begin : pair, upper_of(box), leaf ? count : 0);
        }
        open = splits;
        if (!subgroupAny(open)) break;

        const uint target = !splits ? lane
                            : goes_left ? begin + left_before
                                        : begin + left_count + (lane - begin - left_before);
        const uvec4 low_word = uvec4(floatBitsToUint(lower), id), high_word = uvec4(floatBitsToUint(upper), 0);
        [[unroll]] for (uint k = 0; k < 4; ++k) {
            lane_words[k * gl_SubgroupSize + target] = low_word[k];
            lane_words[(4 + k) * gl_SubgroupSize + target] = high_word[k];
        }
        subgroup_sync();
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            lower[k] = uintBitsToFloat(lane_words[k * gl_SubgroupSize + lane]);
            upper[k] = uintBitsToFloat(lane_words[(4 + k) * gl_SubgroupSize + lane]);
        }
        id = lane_words[3 * gl_SubgroupSize + lane];
        subgroup_sync();
        if (splits) {
            const uint pair = 2 * (task.first + begin + left_count) - 1;
            if (lane < begin + left_count) {
                end = begin + left_count;
                node = pair;
            } else {
                begin = begin + left_count;
                node = pair + 1;
            }
        }
        pool_spend(2 * task.count + 2);
    }
    if (used) pool.client.order.at[task.first + lane] = id;
}
