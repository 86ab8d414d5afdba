// What follows upon a step: the life of a task, phase by phase.

uint chunks_of(uint count) { return (count + kChunkPrimitives - 1) / kChunkPrimitives; }

/// The first step of a task that has its range and bounds; its rule is set.
Next first_step(Task task) {
    if (task.count <= kSubtreePrimitives) return next_step(kPhaseSubtree, 0, 1);
    if (task.count <= kChunkPrimitives) return next_step(kPhaseSmall, 0, 1);
    return next_step(task.looks ? kPhaseBins : kPhaseCount, 0, chunks_of(task.count));
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
    write_inner_node(task);
    return next_spawn(2);
}

Next after_partition(inout Task task) {
    KeyBox boxes[4];
    fetch_boxes(task.first, boxes);
    take_children(task, boxes);
    return split_task(task);
}

Task child_of(Task parent, uint child) {
    const Task task = task_of(child_range(parent, child));
    if (task.count > kChunkPrimitives) clear_scratch(task.first);
    return task;
}
