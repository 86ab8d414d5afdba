// What follows upon a step: the life of a task, phase by phase.

uint chunks_of(uint count) { return (count + kChunkPrimitives - 1) / kChunkPrimitives; }

/// The first step of a task that has its range and bounds; its rule is set by child_of().
Next first_step(Task task) {
    if (task.count <= kLeafRange) return next_step(kPhaseLeaves, 0, 1);
    if (task.count <= kChunkPrimitives) return next_step(kPhaseSmall, 0, 1);
    return next_step(task.looks ? kPhaseBins : kPhaseCount, 0, chunks_of(task.count));
}

/// Rule of a fresh task. Halving bounds the depth: once only halving can still finish above kMaxDepth.
void set_rule(inout Task task) {
    precise vec3 extent = task.center_upper - task.center_lower;
    const uint halvings = uint(findMSB(max(task.count, 1u))) + 1;
    const bool halve = task.depth + halvings >= kMaxDepth || extent == vec3(0);
    task.rule = kSpatialMedian && !halve ? kRuleMiddle : kRuleHalve;
    task.looks = !kSpatialMedian && !halve;
    task.axes = 7;
    task.bin_offset = vec3(0);
    task.bin_scale = vec3(bin_scale(extent.x), bin_scale(extent.y), bin_scale(extent.z));
    task.axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    precise float middle = 0.5 * task.center_lower[task.axis] + 0.5 * task.center_upper[task.axis];
    task.middle = middle;
}

/// The root's bounds have been gathered in scratch 0; goes on with its first step.
Next start_root(inout Task task) {
    KeyBox boxes[4];
    fetch_boxes(0, boxes);
    task.box = boxes[0];
    const KeyBox centers = boxes[1];
    if (task.count == 0) {
        if (subgroupElect())
            pool.client.nodes.at[0] = BvhNode(vec3(kInfinity), 0, vec3(-kInfinity), 0);
        return next_end();
    }
    task.center_lower = lower_of(centers);
    task.center_upper = upper_of(centers);
    set_rule(task);
    clear_scratch(0);
    return first_step(task);
}

Next after_setup(inout Task task) {
    const uint all = task.count;
    const uint valid = scan_chunks(0, all, 0, 1);
    task.left_count = valid;
    if (valid < all) return next_step(kPhaseCompact, 0, valid == 0 ? 0 : chunks_of(all));
    return start_root(task);
}

Next after_compact(inout Task task) {
    task.count = task.left_count;
    task.side = 1;
    return start_root(task);
}

Next after_bins(inout Task task, uint look) {
    Bin bins[kRows];
    fetch_bins(task.first, bins);
    const bool last = look + 1 == looks(task);
    choose_split(task, bins, last);
    clear_scratch(task.first);
    const uint chunks = chunks_of(task.count);
    if (!last) return next_step(kPhaseBins, look + 1, chunks);
    if (task.rule != kRuleBins) return next_step(kPhaseCount, 0, chunks);
    task.left_count = scan_chunks(task.first, task.count, task.axis * kBins, task.cut + 1);
    return next_step(kPhasePartition, 0, chunks);
}

Next after_count(inout Task task, uint step) {
    task.left_count = scan_chunks(task.first, task.count, 0, 1);
    if (task.left_count == 0 || task.left_count == task.count) {
        // The middle of the centres separated nothing.
        task.rule = kRuleHalve;
        return next_step(kPhaseCount, step + 1, chunks_of(task.count));
    }
    return next_step(kPhasePartition, 0, chunks_of(task.count));
}

/// Writes the task's inner node and spawns its children.
Next split_task(inout Task task) {
    if (subgroupElect())
        pool.client.nodes.at[task.node] =
            BvhNode(lower_of(task.box), 2 * (task.first + task.left_count) - 1, upper_of(task.box), 0);
    return next_spawn(2);
}

/// The middle of the centres may have separated nothing: the range is halved by place then.
Next after_small(inout Task task) {
    if (task.left_count != 0 && task.left_count != task.count) return split_task(task);
    task.rule = kRuleHalve;
    task.looks = false;
    return next_step(kPhaseSmall, 0, 1);
}

Next after_partition(inout Task task) {
    KeyBox boxes[4];
    fetch_boxes(task.first, boxes);
    take_children(task, boxes);
    return split_task(task);
}

Task child_of(Task parent, uint child) {
    Task task;
    task.first = parent.first + (child == 0 ? 0 : parent.left_count);
    task.count = child == 0 ? parent.left_count : parent.count - parent.left_count;
    task.node = 2 * (parent.first + parent.left_count) - 1 + child;
    task.depth = parent.depth + 1;
    task.side = 1 - parent.side;
    task.box = parent.left_box;
    KeyBox centers = parent.left_centers;
    if (child == 1) {
        task.box = parent.right_box;
        centers = parent.right_centers;
    }
    task.center_lower = lower_of(centers);
    task.center_upper = upper_of(centers);
    task.left_count = 0;
    set_rule(task);
    if (task.count > kChunkPrimitives) clear_scratch(task.first);
    return task;
}
