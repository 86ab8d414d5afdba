// Choosing splits and partitioning ranges, in chunks of large tasks and whole for small ones. Which side
// a primitive goes to depends on nothing but its box (or, to halve a range, on its place), and it
// lands at a place that depends on nothing but the order before: builds are deterministic.

/// Side test of a task's split, evaluated the same way wherever it is needed.
bool goes_left(Task task, uint place, vec3 center) {
    if (task.rule == kRuleHalve) return place < task.first + task.count / 2;
    if (task.rule == kRuleBins) return bin_of(task, center, task.axis) <= task.cut;
    return component(center, task.axis) <= task.middle;
}

/// Splits [begin, end) of the task's range to places from `left` up and from `right` down. Returns how
/// many went left; `boxes` become those of the left and the right primitives and of their centres, in
/// the order of take_children().
uint move_range(Task task, uint begin, uint end, uint left, uint right, out KeyBox boxes[4]) {
    boxes = no_boxes();
    const uint left_begin = left;
    Primitives primitives = primitives_of(task.side);
    Primitive next = primitives.at[min(begin + gl_SubgroupInvocationID, end - 1)];
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const bool used = mine < end;
        const Primitive primitive = next;
        next = primitives.at[min(mine + gl_SubgroupSize, end - 1)];
        precise vec3 center = primitive.lower + primitive.upper;
        const bool is_left = used && goes_left(task, mine, center);
        const bool is_right = used && !is_left;
        const uint lefts_to_here = sum_to_here(is_left ? 1 : 0);
        const uint lefts_before = lefts_to_here - (is_left ? 1 : 0);
        const uint target = is_left ? left + lefts_before
                                    : right - 1 - (gl_SubgroupInvocationID - lefts_before);
        if (used) primitives_of(1 - task.side).at[target] = primitive;
        const uint left_count = subgroupShuffle(lefts_to_here, kLanes - 1);
        left += left_count;
        right -= min(end - i, gl_SubgroupSize) - left_count;
        const KeyBox keys = keys_of(primitive.lower, primitive.upper), key = keys_of(center, center);
        take_in(boxes[0], keys, is_left);
        take_in(boxes[1], key, is_left);
        take_in(boxes[2], keys, is_right);
        take_in(boxes[3], key, is_right);
    }
    join_lanes(boxes);
    pool_spend((end - begin) / gl_SubgroupSize + 2 + kReduceIterations);
    return left - left_begin;
}

uint count_left(Task task, uint begin, uint end) {
    uint count = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = primitives_of(task.side).at[min(mine, end - 1)];
        precise vec3 center = primitive.lower + primitive.upper;
        count += subgroupBallotBitCount(
            subgroupBallot(mine < end && goes_left(task, mine, center)));
    }
    pool_spend((end - begin) / gl_SubgroupSize);
    return count;
}

// ---- Chunks of large tasks ------------------------------------------------------------------------

void count_chunk(Task task, uint begin, uint end) {
    const uint count = count_left(task, begin, end);
    if (subgroupElect()) pool.client.scratch.words[chunk_word(begin, end)] = count;
}

void take_children(inout Task task, KeyBox boxes[4]) {
    task.left_box = boxes[0];
    task.left_centers = boxes[1];
    task.right_box = boxes[2];
    task.right_centers = boxes[3];
}

/// Brings the primitives of [begin, end) nearer: many misses at a time, where passing them one by one
/// would wait for each. Every other one will do: two share a cache line. Makes some use of what it reads,
/// lest it be left out, and the same in all lanes, as the count of iterations has to be.
void touch(Task task, uint begin, uint end) {
    Primitives primitives = primitives_of(task.side);
    uint seen = 0;
    for (uint i = begin; i < end; i += 2 * kLanes)
        seen |= primitives.at[min(i + 2 * gl_SubgroupInvocationID, end - 1)].id;
    pool_spend((subgroupAny(seen != 0) ? 1 : 0) + kChunkPrimitives / (2 * kLanes));
}

/// Looks that a task gets: finer ones pay where much is split, and where the tree is nearly done.
uint looks(Task task) {
    if (!task.looks) return 0;
    if (task.count > 4 * kChunkPrimitives) return 3;
    return task.count > kChunkPrimitives || task.count <= kFewPrimitives ? 2 : 1;
}

/// A chunk of a large task's looks or of its partition, or a whole small task's looks and partition, or
/// a whole subtree: together, so that there is one copy of each in the kernel.
void split_chunk(inout Task task, uint phase, uint step, uint begin, uint end) {
    const bool subtree = phase == kPhaseSubtree, small = phase == kPhaseSmall || subtree;
    if (!small) touch(task, begin, end);
    Range waiting;     // this lane's of the subtree's ranges that wait
    uint waiting_count = 0;
    bool more = true;
    while (more) {
        pool_spend(kTurnIterations);  // as the loops that this turn passes over count, too
        Range next;
        if (subtree && task.count <= kLeafRange) {
            build_leaves(task);
            more = waiting_count > 0;
            if (more) next = range_from(--waiting_count, waiting);
        } else {
            const uint all = looks(task);
            const uint end_look = phase == kPhaseBins ? step + 1 : small ? all : 0;
            for (uint look = phase == kPhaseBins ? step : 0; look < end_look; ++look) {
                Bin bins[kRows];
                clear_bins(bins);
                pass_primitives(task, begin, end, bins);
                const bool last = look + 1 == all;
                if (small) choose_split(task, bins, last);
                else {
                    flush_bins(task.first, bins);
                    if (last) tell_counts(begin, end, bins);
                }
            }
            if (phase == kPhaseBins) return;
            uint left = task.first, right = task.first + task.count;
            if (!small) {
                const uint left_before = pool.client.scratch.words[chunk_word(begin, end)];
                left += left_before;
                right -= begin - task.first - left_before;
            }
            KeyBox boxes[4];
            const uint left_count = move_range(task, begin, end, left, right, boxes);
            if (!small) {
                flush_boxes(task.first, boxes);
                return;
            }
            task.left_count = left_count;
            take_children(task, boxes);
            pool_order_lanes();  // the next turn reads what other lanes moved
            if (left_count == 0 || left_count == task.count) {
                // The middle of the centres separated nothing.
                task.rule = kRuleHalve;
                task.looks = false;
                continue;
            }
            if (!subtree) return;
            write_inner_node(task);
            // The smaller child comes first: at most log2(kSubtreePrimitives / kLeafRange) wait.
            const uint smaller = 2 * left_count <= task.count ? 0 : 1;
            if (gl_SubgroupInvocationID == waiting_count) waiting = child_range(task, 1 - smaller);
            ++waiting_count;
            next = child_range(task, smaller);
        }
        if (more) {
            task = task_of(next);
            begin = task.first;
            end = task.first + task.count;
        }
    }
}
