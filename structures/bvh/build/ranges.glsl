// From a range of primitives to the task that splits it, and from that to the ranges of its children.

/// What is known of a range when its parent has been split.
struct Range {
    uint first, count;
    uint node, depth;
    uint side;
    KeyBox box, centers;
};

/// About kBins / extent, by Newton's method as divisions differ between devices; 0 where nothing can be
/// told apart.
float bin_scale(float extent) {
    const uint bits = floatBitsToUint(extent), exponent = bits >> 23;
    const float mantissa = uintBitsToFloat(bits & 0x7fffffu | 0x3f000000u);  // 0.5 to 1
    precise float inverse = 2.9142 - 2.0 * mantissa;
    [[unroll]] for (uint k = 0; k < 2; ++k) {
        precise float better = inverse * (2.0 - mantissa * inverse);
        inverse = better;
    }
    if (exponent < 32 || exponent > 230) return 0;
    return inverse * (float(kBins) * uintBitsToFloat((253 - exponent) << 23));
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

Task task_of(Range range) {
    Task task;
    task.first = range.first;
    task.count = range.count;
    task.node = range.node;
    task.depth = range.depth;
    task.side = range.side;
    task.box = range.box;
    task.center_lower = lower_of(range.centers);
    task.center_upper = upper_of(range.centers);
    task.left_count = 0;
    set_rule(task);
    return task;
}

Range child_range(Task parent, uint child) {
    Range range;
    range.first = parent.first + (child == 0 ? 0 : parent.left_count);
    range.count = child == 0 ? parent.left_count : parent.count - parent.left_count;
    range.node = 2 * (parent.first + parent.left_count) - 1 + child;
    range.depth = parent.depth + 1;
    range.side = 1 - parent.side;
    range.box = parent.left_box;
    range.centers = parent.left_centers;
    if (child == 1) {
        range.box = parent.right_box;
        range.centers = parent.right_centers;
    }
    return range;
}

KeyBox box_from(uint lane, KeyBox box) {
    return KeyBox(subgroupShuffle(box.low, lane), subgroupShuffle(box.high, lane));
}
/// The lane's range.
Range range_from(uint lane, Range range) {
    return Range(subgroupShuffle(range.first, lane), subgroupShuffle(range.count, lane),
                 subgroupShuffle(range.node, lane), subgroupShuffle(range.depth, lane),
                 subgroupShuffle(range.side, lane), box_from(lane, range.box),
                 box_from(lane, range.centers));
}

void write_inner_node(Task task) {
    if (subgroupElect())
        pool.client.nodes.at[task.node] =
            BvhNode(lower_of(task.box), 2 * (task.first + task.left_count) - 1, upper_of(task.box), 0);
}
