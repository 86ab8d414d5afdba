// Binning and partitioning of ranges, in chunks of large tasks and whole for small ones. Which side a
// primitive goes to depends on nothing but its box (or, to halve a range, on its place), and it
// lands at a place that depends on nothing but the order before: builds are deterministic.

/// Side test of a task's split, evaluated the same way wherever it is needed.
bool goes_left(Task task, uint place, vec3 center, vec3 scale) {
    if (task.rule == kRuleHalve) return place < task.first + task.count / 2;
    if (task.rule == kRuleMiddle) {
        precise float middle = 0.5 * task.center_lower[task.axis] + 0.5 * task.center_upper[task.axis];
        return center[task.axis] < middle;
    }
    return bin_of(center, task.center_lower, scale)[task.axis] <= task.plane;
}

void bin_range(Task task, uint begin, uint end) {
    const vec3 scale = bin_scale(task.center_lower, task.center_upper);
    clear_bins();
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        if (mine < end) {
            const Primitive primitive = load_primitive(task.side, mine);
            precise vec3 center = primitive.lower + primitive.upper;
            const uvec3 bin = bin_of(center, task.center_lower, scale);
            const KeyBox box = keys_of(primitive.lower, primitive.upper);
            [[unroll]] for (uint axis = 0; axis < 3; ++axis) add_to_bin(axis, bin[axis], box);
        }
    }
    merge_columns();
    pool_spend((end - begin) / gl_SubgroupSize + kAllBinWords * (kColumns + 2) / gl_SubgroupSize);
}

/// Turns a plane into the task's split rule.
void choose(inout Task task, uint plane) {
    task.rule = plane == kNoPlane ? kRuleHalve : kRuleBin;
    if (plane == kNoPlane) return;
    task.axis = plane / kBins;
    task.plane = plane % kBins;
}

/// Splits [begin, end) of the task's range to places from `left` up and from `right` down, and grows
/// the children's bounds in reduce_rows. Returns how many went left.
uint move_range(Task task, uint begin, uint end, uint left, uint right) {
    const vec3 scale = bin_scale(task.center_lower, task.center_upper);
    KeyBox box[2] = KeyBox[](empty_keys(), empty_keys());
    KeyBox centers[2] = box;
    const uint left_begin = left;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const bool used = mine < end;
        const Primitive primitive = load_primitive(task.side, min(mine, end - 1));
        precise vec3 center = primitive.lower + primitive.upper;
        const bool is_left = used && goes_left(task, mine, center, scale);
        const bool is_right = used && !is_left;
        const uvec4 lefts = subgroupBallot(is_left), rights = subgroupBallot(is_right);
        const uint target = is_left ? left + subgroupBallotExclusiveBitCount(lefts)
                                    : right - 1 - subgroupBallotExclusiveBitCount(rights);
        if (used) store_primitive(1 - task.side, target, primitive);
        left += subgroupBallotBitCount(lefts);
        right -= subgroupBallotBitCount(rights);
        const KeyBox keys = keys_of(primitive.lower, primitive.upper), key = keys_of(center, center);
        box[0] = join(box[0], keep_if(is_left, keys));
        box[1] = join(box[1], keep_if(is_right, keys));
        centers[0] = join(centers[0], keep_if(is_left, key));
        centers[1] = join(centers[1], keep_if(is_right, key));
    }
    [[unroll]] for (uint side = 0; side < 2; ++side) {
        store_rows(side * 2 * kKeys, box[side]);
        store_rows(side * 2 * kKeys + kKeys, centers[side]);
    }
    max_rows(4 * kKeys);
    pool_spend((end - begin) / gl_SubgroupSize + 4 * gl_SubgroupSize);
    return left - left_begin;
}

uint count_left(Task task, uint begin, uint end) {
    const vec3 scale = bin_scale(task.center_lower, task.center_upper);
    uint count = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = load_primitive(task.side, min(mine, end - 1));
        precise vec3 center = primitive.lower + primitive.upper;
        count += subgroupBallotBitCount(
            subgroupBallot(mine < end && goes_left(task, mine, center, scale)));
    }
    pool_spend((end - begin) / gl_SubgroupSize);
    return count;
}

// ---- Chunks of large tasks ------------------------------------------------------------------------

void bin_chunk(Task task, uint begin, uint end) {
    bin_range(task, begin, end);
    for (uint i = gl_SubgroupInvocationID; i < kAllBinWords; i += gl_SubgroupSize) {
        const uint word = scratch_word(task.first) + i;
        if (i % kBinWords == kKeys) atomicAdd(pool.client.scratch.words[word], bins[i]);
        else atomicMax(pool.client.scratch.words[word], bins[i]);
    }
}

void count_chunk(Task task, uint begin, uint end) {
    const uint count = count_left(task, begin, end);
    if (subgroupElect()) pool.client.scratch.words[chunk_word(begin, end)] = count;
}

void partition_chunk(Task task, uint begin, uint end) {
    const uint left_before = pool.client.scratch.words[chunk_word(begin, end)];
    const uint right_before = begin - task.first - left_before;
    move_range(task, begin, end, task.first + left_before, task.first + task.count - right_before);
    flush_rows(task.first, 4 * kKeys);
}

// ---- Whole small tasks ----------------------------------------------------------------------------

/// The children's bounds, from four boxes of keys at reduce_rows[0].
void take_children(inout Task task) {
    task.left_box = reduced(0);
    task.left_centers = reduced(kKeys);
    task.right_box = reduced(2 * kKeys);
    task.right_centers = reduced(3 * kKeys);
}

/// A whole task of at most one chunk.
void small_task(inout Task task) {
    const uint end = task.first + task.count;
    if (task.rule == kRuleBin) {
        bin_range(task, task.first, end);
        choose(task, best_plane());
    }
    task.left_count = move_range(task, task.first, end, task.first, end);
    if (task.left_count == 0 || task.left_count == task.count) {
        // The middle of the centres separated nothing: halve by place instead.
        task.rule = kRuleHalve;
        task.left_count = move_range(task, task.first, end, task.first, end);
    }
    take_children(task);
}
