// Choosing what splits a range: the pivot and its delta.

/// Reaches that lanes look through, with the distance to the middle as third: of a range's sample, or
/// kLeafRange for each lane of a leaf.
shared vec3 reaches[kMostLeafRange * kMostLeafRange];

/// Some number below `count` that depends on the range, the attempt and `index`.
uint pick(Task task, uint index, uint count) {
    uint h = pool.client.seed + task.range.first * 0x9e3779b1u + task.attempt * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du + index * 0xc2b2ae35u;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    h ^= h >> 15;
    uint high, low;
    umulExtended(h, count, high, low);
    return high;
}

/// As reference.cpp, which says why.
const float kCostPower = 1.2, kOverFactor = 1.5;

/// Expected cost of a query among the elements whose `count` reaches begin at `from`, queries being
/// spread like their middles.
float cost_of(uint from, uint count, float delta) {
    Bounds bounds = no_bounds();
    vec3 sizes = vec3(0), entering = vec3(0);
    for (uint k = 0; k < count; ++k) {
        const vec3 reach = reaches[from + k];
        const uint part = part_of(reach, delta);
        take_in(bounds, reach, part);
        sizes += vec3(part == kNear, part == kFar, part == kOver);
    }
    for (uint k = 0; k < count; ++k) {
        const float d = reaches[from + k].z;
        entering += vec3(d <= bounds.near_max, d >= bounds.far_min,
                         d >= bounds.over_min && d <= bounds.over_max);
    }
    return dot(entering * vec3(1, 1, kOverFactor), pow(sizes, vec3(kCostPower)));
}

/// By how much more of the middles are on one side of delta than on the other.
float imbalance_of(uint from, uint count, float delta) {
    float imbalance = 0;
    for (uint k = 0; k < count; ++k) imbalance += sign(reaches[from + k].z - delta);
    return abs(imbalance);
}

struct Choice {
    float cost, delta;
};

uint candidates_of(uint count) { return kByCost ? 3 * min(kQuantiles, count) : count; }
/// Loop iterations of best_delta(), with each loop's last, in which it ends.
uint choice_iterations(uint count, uint stride) {
    return (candidates_of(count) / stride + 2) * ((kByCost ? 2 : 1) * (count + 1) + 1);
}

/// The best delta for the `count` reaches from `from` on, among every `stride`-th candidate.
Choice best_delta(uint from, uint count, uint start, uint stride) {
    Choice best = Choice(kInfinity, 0.0);
    const uint picked = kByCost ? min(kQuantiles, count) : count, candidates = candidates_of(count);
    for (uint c = start; c < candidates; c += stride) {
        // The sample is in no order, so any share of it will do for quantiles.
        const vec3 reach = reaches[from + c % picked * count / picked];
        const float delta = !kByCost || c < picked ? reach.z : c < 2 * picked ? reach.y : reach.x;
        const float cost = kByCost ? cost_of(from, count, delta) : imbalance_of(from, count, delta);
        if (cost < best.cost) best = Choice(cost, delta);
    }
    return best;
}

/// How good a pivot is that has these reaches, with a delta by cost: the spread of the distances. A median
/// often is a bad delta, so pivots for it are judged by cost, at their mean distance.
float merit_of(uint from, uint count) {
    float sum = 0, squares = 0;
    for (uint k = 0; k < count; ++k) sum += reaches[from + k].z;
    const float mean = sum / float(max(count, 1u));
    if (!kByCost) return -cost_of(from, count, mean);
    for (uint k = 0; k < count; ++k) squares += (reaches[from + k].z - mean) * (reaches[from + k].z - mean);
    return squares;
}

/// Sets the task's pivot and delta. After kTries that did not tell elements apart, the first element
/// that all others overlap.
void choose(inout Task task) {
    const Range range = task.range;
    const bool listed = task.attempt == kTries;
    // Each lane has a candidate.
    const uint candidate = gl_SubgroupInvocationID % kCandidates, row = candidate * kPivotSample;
    const uint place = range.first + (listed ? 0 : pick(task, candidate, range.count));
    const uint id = id_at(range.side, place);
    const Element mine = element_of(id);
    const uint samples = listed ? 0 : min(range.count, kPivotSample);
    for (uint k = 0; k < samples; ++k) {
        const uint other =
            samples == range.count ? k : pick(task, kCandidates + k, range.count);
        reaches[row + k] = reach_between(mine, element_of(id_at(range.side, range.first + other)));
    }
    float merit = merit_of(row, samples);
    uint lane = gl_SubgroupInvocationID;  // of equal ones, the lowest
    [[unroll]] for (uint k = 0; k < kLaneBits; ++k) {
        if (1u << k >= kLanes) continue;
        const float other = subgroupShuffleXor(merit, 1u << k);
        const uint from = subgroupShuffleXor(lane, 1u << k);
        const bool take = other > merit || (other == merit && from < lane);
        merit = take ? other : merit;
        lane = take ? from : lane;
    }
    subgroup_sync();
    lane = subgroupShuffle(lane, 0);  // also if something is not a number
    task.pivot = subgroupShuffle(place, lane);
    task.node = subgroupShuffle(id, lane);

    const Element pivot = element_of(task.node);
    const uint others = range.count - 1, sampled = listed ? 0 : min(others, kDeltaSample);
    for (uint k = gl_SubgroupInvocationID; k < sampled; k += kLanes) {
        const uint other =
            range.first + (sampled == others ? k : pick(task, kCandidates + kPivotSample + k, others));
        const uint at = other + (other >= task.pivot ? 1 : 0);
        reaches[k] = reach_between(pivot, element_of(id_at(range.side, at)));
    }
    subgroup_sync();
    Choice best = best_delta(0, sampled, gl_SubgroupInvocationID, kLanes);
    [[unroll]] for (uint k = 0; k < kLaneBits; ++k) {
        if (1u << k >= kLanes) continue;
        const Choice other = Choice(subgroupShuffleXor(best.cost, 1u << k),
                                    subgroupShuffleXor(best.delta, 1u << k));
        if (other.cost < best.cost || (other.cost == best.cost && other.delta < best.delta))
            best = other;
    }
    subgroup_sync();
    task.delta = listed ? -1.0 : subgroupShuffle(best.delta, 0);
    if (is_large(range)) clear_tally(range);
    pool_spend(4 * (samples + 1) + sampled / kLanes + 2 + choice_iterations(sampled, kLanes));
}
