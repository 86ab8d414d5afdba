// Chunks that pass over a range's elements: finding them, classifying and moving them, making a list.
//
// Scratch of a large range's chunk, named by where it begins: how many of its elements are near, how
// many far, and after the scan how many such are before it; of the range, where it begins, the bounds
// of the parts. Ranges of one chunk have all that in their task.

const uint kPartShift = 30;  // above the bits of kLinkMask
const uint kNearCount = 0, kFarCount = 1, kBoundsWord = 2;

uint scratch_word(uint begin) { return begin / kChunkElements * kScratchWords; }

// ---- The elements of all clusters -----------------------------------------------------------------

/// Counts the elements among the clusters [begin, end), or writes their numbers to where the scanned
/// counts say.
void gather_chunk(uint begin, uint end, bool counting) {
    const uint word = scratch_word(begin);
    uint target = counting ? 0 : uint(pool.client.scratch.at[word]);
    for (uint i = begin; i < end; i += kLanes) {
        const uint mine = i + gl_SubgroupInvocationID;
        const float radius = pool.client.nodes.at[min(mine, end - 1)].radius;
        const bool taken = mine < end && radius >= 0 && !isinf(radius);
        const uint to_here = sum_to_here(taken ? 1 : 0);
        if (taken && !counting) pool.client.ids[0].at[target + to_here - 1] = mine;
        target += subgroupShuffle(to_here, kLanes - 1);
    }
    if (counting && subgroupElect()) {
        pool.client.scratch.at[word] = int(target);
        pool_progress(end - begin - target);
    }
    pool_spend((end - begin) / kLanes + 2);
}

/// Exclusive scan of word `word` of a range's chunks; returns the sum.
uint scan_chunks(Range range, uint word) {
    const uint chunks = chunk_count(range.count);
    uint sum = 0;
    for (uint i = 0; i < chunks; i += kLanes) {
        const uint chunk = i + gl_SubgroupInvocationID;
        const uint at =
            scratch_word(range.first + min(chunk, chunks - 1) * kChunkElements) + word;
        const uint mine = chunk < chunks ? uint(pool.client.scratch.at[at]) : 0;
        const uint to_here = sum_to_here(mine);
        if (chunk < chunks) pool.client.scratch.at[at] = int(sum + to_here - mine);
        sum += subgroupShuffle(to_here, kLanes - 1);
        pool_spend(1);
    }
    pool_order_lanes();
    return sum;
}
uint scan_elements(Range all) { return all.count == 0 ? 0 : scan_chunks(all, kNearCount); }

// ---- Three parts ----------------------------------------------------------------------------------
// Bounds are compared as integers: floats that are not negative order alike, and -1 is below them.

void clear_tally(Range range) {
    const Bounds bounds = no_bounds();
    const uint word = scratch_word(range.first) + kBoundsWord;
    if (!subgroupElect()) return;
    pool.client.scratch.at[word + 0] = floatBitsToInt(bounds.near_max);
    pool.client.scratch.at[word + 1] = floatBitsToInt(bounds.far_min);
    pool.client.scratch.at[word + 2] = floatBitsToInt(bounds.over_min);
    pool.client.scratch.at[word + 3] = floatBitsToInt(bounds.over_max);
    pool.client.scratch.at[word + 4] = floatBitsToInt(bounds.min_depth);
}

void take_tally(inout Task task) {
    task.counts[kNear] = scan_chunks(task.range, kNearCount);
    task.counts[kFar] = scan_chunks(task.range, kFarCount);
    task.counts[kOver] = task.range.count - 1 - task.counts[kNear] - task.counts[kFar];
    const uint word = scratch_word(task.range.first) + kBoundsWord;
    task.bounds = Bounds(intBitsToFloat(pool.client.scratch.at[word]),
                         intBitsToFloat(pool.client.scratch.at[word + 1]),
                         intBitsToFloat(pool.client.scratch.at[word + 2]),
                         intBitsToFloat(pool.client.scratch.at[word + 3]),
                         intBitsToFloat(pool.client.scratch.at[word + 4]));
}

/// Tells each element's part, above its number, and what is known of the parts.
void classify_chunk(inout Task task, uint begin, uint end) {
    const Element pivot = element_of(task.node);
    Bounds bounds = no_bounds();
    uint near_count = 0, far_count = 0;
    for (uint i = begin; i < end; i += kLanes) {
        const uint mine = i + gl_SubgroupInvocationID;
        const uint id = id_at(task.range.side, min(mine, end - 1));
        const vec3 reach = reach_between(pivot, element_of(id));
        const uint part = part_of(reach, task.delta);
        const bool other = mine < end && mine != task.pivot;
        if (mine < end)
            bounds.min_depth = min(bounds.min_depth, pool.client.nodes.at[id].min_depth);
        if (other) {
            take_in(bounds, reach, part);
            near_count += part == kNear ? 1 : 0;
            far_count += part == kFar ? 1 : 0;
            ids_of(task.range.side).at[mine] = id | part << kPartShift;
        }
    }
    bounds = Bounds(lane_max(bounds.near_max), lane_min(bounds.far_min), lane_min(bounds.over_min),
                    lane_max(bounds.over_max), lane_min(bounds.min_depth));
    near_count = lane_sum(near_count);
    far_count = lane_sum(far_count);
    pool_spend((end - begin) / kLanes + 2);
    if (!is_large(task.range)) {
        task.bounds = bounds;
        task.counts =
            uint[](near_count, far_count, task.range.count - 1 - near_count - far_count);
        return;
    }
    if (!subgroupElect()) return;
    pool.client.scratch.at[scratch_word(begin) + kNearCount] = int(near_count);
    pool.client.scratch.at[scratch_word(begin) + kFarCount] = int(far_count);
    const uint word = scratch_word(task.range.first) + kBoundsWord;
    atomicMax(pool.client.scratch.at[word], floatBitsToInt(bounds.near_max));
    atomicMin(pool.client.scratch.at[word + 1], floatBitsToInt(bounds.far_min));
    atomicMin(pool.client.scratch.at[word + 2], floatBitsToInt(bounds.over_min));
    atomicMax(pool.client.scratch.at[word + 3], floatBitsToInt(bounds.over_max));
    atomicMin(pool.client.scratch.at[word + 4], floatBitsToInt(bounds.min_depth));
}

/// Moves the elements, but for the pivot, to the other side: near ones first, overlapping ones last, all
/// in their order.
void partition_chunk(Task task, uint begin, uint end) {
    const uint first = task.range.first, passed = begin - first - (task.pivot < begin ? 1 : 0);
    uint near_before = 0, far_before = 0;
    if (is_large(task.range)) {
        near_before = uint(pool.client.scratch.at[scratch_word(begin) + kNearCount]);
        far_before = uint(pool.client.scratch.at[scratch_word(begin) + kFarCount]);
    }
    uint near_at = first + 1 + near_before;
    uint far_at = first + 1 + task.counts[kNear] + far_before;
    uint over_at = first + 1 + task.counts[kNear] + task.counts[kFar] + passed - near_before - far_before;
    for (uint i = begin; i < end; i += kLanes) {
        const uint mine = i + gl_SubgroupInvocationID;
        const uint word = ids_of(task.range.side).at[min(mine, end - 1)];
        const uint part = word >> kPartShift;
        const bool used = mine < end && mine != task.pivot;
        // Three counts in a word: there are fewer than 1024 lanes.
        const uint to_here = sum_to_here(used ? 1u << 10 * part : 0);
        const uint all = subgroupShuffle(to_here, kLanes - 1);
        const uint before = bitfieldExtract(to_here, int(10 * part), 10) - 1;
        const uint target = before + (part == kNear ? near_at : part == kFar ? far_at : over_at);
        if (used) ids_of(1 - task.range.side).at[target] = word & kLinkMask;
        near_at += bitfieldExtract(all, 0, 10);
        far_at += bitfieldExtract(all, 10, 10);
        over_at += bitfieldExtract(all, 20, 10);
    }
    pool_spend((end - begin) / kLanes + 2);
}

// ---- Lists ----------------------------------------------------------------------------------------

/// Links the elements one after another along `over`. The first, the pivot, has bounds of its own; the
/// others' hold everything.
void list_chunk(Task task, uint begin, uint end) {
    const uint first = task.range.first, last = first + task.range.count - 1;
    for (uint i = begin; i < end; i += kLanes) {
        const uint place = i + gl_SubgroupInvocationID;
        if (place < end) {
            const uint id = id_at(task.range.side, place);
            pool.client.nodes.at[id].over =
                place < last ? id_at(task.range.side, place + 1) + 1 : 0;
            if (place > first) {
                pool.client.nodes.at[id].ancestor = id_at(task.range.side, place - 1) + 1;
                pool.client.nodes.at[id].over_min = 0;
                pool.client.nodes.at[id].over_max = kInfinity;
                pool.client.nodes.at[id].min_depth = task.bounds.min_depth;
            }
        }
    }
    if (begin == first) {
        reach_depth(task.range.depth);
        if (subgroupElect())
            atomicAdd(pool.client.header.header.bucketed, task.range.count - 1);
    }
    pool_progress(end - begin);
    pool_spend((end - begin) / kLanes + 2);
}
