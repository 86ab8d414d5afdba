// Choosing planes and partitioning ranges, in chunks of large tasks and whole for small ones. Which side a
// primitive goes to depends on nothing but its box (or, to halve a range, on its place), and it
// lands at a place that depends on nothing but the order before: builds are deterministic.

/// Side test of a task's split, evaluated the same way wherever it is needed.
bool goes_left(Task task, uint place, vec3 center) {
    if (task.rule == kRuleHalve) return place < task.first + task.count / 2;
    return (task.axis == 0 ? center.x : task.axis == 1 ? center.y : center.z) <= task.position;
}

/// Splits [begin, end) of the task's range to places from `left` up and from `right` down, and grows
/// the children's bounds in reduce_rows. Returns how many went left.
uint move_range(Task task, uint begin, uint end, uint left, uint right) {
    KeyBox box[2] = KeyBox[](empty_keys(), empty_keys());
    KeyBox centers[2] = box;
    const uint left_begin = left;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const bool used = mine < end;
        const Primitive primitive = load_primitive(task.side, min(mine, end - 1));
        precise vec3 center = primitive.lower + primitive.upper;
        const bool is_left = used && goes_left(task, mine, center);
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
    uint count = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = load_primitive(task.side, min(mine, end - 1));
        precise vec3 center = primitive.lower + primitive.upper;
        count += subgroupBallotBitCount(
            subgroupBallot(mine < end && goes_left(task, mine, center)));
    }
    pool_spend((end - begin) / gl_SubgroupSize);
    return count;
}

// ---- Chunks of large tasks ------------------------------------------------------------------------

/// A step is a round.
void planes_chunk(Task task, uint round, uint begin, uint end) {
    Plane planes[kRows];
    make_planes(task, round, planes);
    const uint passed = pass_primitives(task, begin, end, planes);
    flush_planes(task.first, planes, passed);
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
    const uint rounds = task.cost == 0 ? 0 : task.count > kRoundLimit ? kSmallRounds : 1;
    for (uint round = 0; round < rounds; ++round) {
        Plane planes[kRows];
        make_planes(task, round, planes);
        choose_plane(task, planes, pass_primitives(task, task.first, end, planes));
    }
    task.left_count = move_range(task, task.first, end, task.first, end);
    if (task.left_count == 0 || task.left_count == task.count) {
        // The middle of the centres separated nothing: halve by place instead.
        task.rule = kRuleHalve;
        task.left_count = move_range(task, task.first, end, task.first, end);
    }
    take_children(task);
}
