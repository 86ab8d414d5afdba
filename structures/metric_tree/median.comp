// Top-down build of a ternary metric tree on the task pool: a pivot, every other element's reach from
// it, a delta, three subtrees.
//
// A task owns a range of element numbers. One subgroup chooses pivot and delta from samples
// (median_choice.glsl); chunks measure how far the elements reach, say which of three parts each is
// in, and move them to the other of two arrays, stably (median_partition.glsl); the parts are the
// children's ranges. Ranges of at most kSubtreeElements are finished by one subgroup in one chunk,
// those that fit its lanes by all segments at once (median_leaf.glsl).
//
// Pivots: P. N. Yianilos, "Data Structures and Algorithms for Nearest Neighbor Search in General
// Metric Spaces", 1993. Delta: the median (J. K. Uhlmann, "Satisfying general proximity / similarity
// queries with metric trees", 1991) or the least expected cost, as in reference.cpp; both of a sample,
// so that one pass over the elements is enough to measure and to divide them.
//
// Where no pivot takes a range apart, as with copies of one element, the pivot gets bounds of all the
// others, which become a list along its overlapping link, whose nodes' bounds hold everything.
//
// What becomes of an element depends on the numbers of clusters and on nothing else: equal inputs give
// equal trees on one device, whatever the number of subgroups and the policy.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"
#include "structures/metric_tree/metric_tree_shared.h"
#include "structures/metric_tree/median_shared.h"

layout(constant_id = 16) const bool kDirectional = false;
layout(constant_id = 17) const bool kCapsules = true;
layout(constant_id = 18) const bool kByCost = false;
layout(constant_id = 19) const uint kLanes = 8;      // in a subgroup
layout(constant_id = 20) const uint kLeafRange = 8;  // elements of a leaf; at most kLanes and kMostLeafRange
#include "structures/metric_tree/metric.glsl"

const float kInfinity = 1.0 / 0.0;
const uint kNear = 0, kFar = 1, kOver = 2;  // parts, and links in their order

/// Elements to be linked as one subtree.
struct Range {
    uint first, count;
    uint side;      // which array holds their numbers
    uint owner;     // where the link to the subtree goes: 4 * node + link, or kRootOwner
    uint ancestor;  // link to the node whose overlapping subtree that is in
    uint depth;     // nodes on the way to the subtree's root, itself among them
};
const uint kRootOwner = 0xffffffffu;

/// Bounds of three parts, as a node holds them.
struct Bounds {
    float near_max, far_min, over_min, over_max, min_depth;
};
Bounds no_bounds() { return Bounds(-1.0, kInfinity, kInfinity, -1.0, kInfinity); }

struct Task {
    Range range;
    uint attempt;
    uint pivot;   // its place
    uint node;    // and its number
    float delta;  // negative: all overlap
    uint counts[3];
    Bounds bounds;
};

pool_buffer(16) Nodes { MetricNode at[]; };
pool_buffer(4) Header { MetricHeader header; };

struct Client {
    Nodes nodes;
    Header header;
    PoolUints ids[2];  // partitioned from one into the other; the part of an element above kLinkMask
    PoolInts scratch;
    uint cluster_count;
    uint seed;
};
#include "taskpool/pool/pool.glsl"

Task task_of(Range range) {
    Task task;
    task.range = range;
    // What is too deep becomes a list: a leaf is no deeper than its elements are many.
    task.attempt = range.depth + kLeafRange >= kMaxDepth ? kTries : 0;
    task.pivot = range.first;
    task.node = 0;
    task.delta = 0;
    task.counts = uint[](0, 0, 0);
    task.bounds = no_bounds();
    return task;
}

PoolUints ids_of(uint side) {
    return PoolUints(side == 0 ? uint64_t(pool.client.ids[0]) : uint64_t(pool.client.ids[1]));
}
uint id_at(uint side, uint place) { return ids_of(side).at[place] & kLinkMask; }

Element element_of(uint id) {
    return Element(pool.client.nodes.at[id].a, pool.client.nodes.at[id].b,
                   pool.client.nodes.at[id].radius);
}

/// The last chunk takes the rest, so that chunks of large ranges, and these themselves, never begin in
/// the same multiple of kChunkElements: that names their scratch.
uint chunk_count(uint count) { return max(count / kChunkElements, 1u); }
bool is_large(Range range) { return chunk_count(range.count) > 1; }

/// reach_of(), and the distance to the middle.
vec3 reach_between(Element pivot, Element element) {
    float middle;
    const vec2 reach = reach_of(pivot, element, middle);
    return vec3(reach, middle);
}

uint part_of(vec3 reach, float delta) {
    return delta < 0 ? kOver : reach.y <= delta ? kNear : reach.x > delta ? kFar : kOver;
}

void take_in(inout Bounds bounds, vec3 reach, uint part) {
    if (part == kNear) bounds.near_max = max(bounds.near_max, reach.y);
    if (part == kFar) bounds.far_min = min(bounds.far_min, reach.x);
    if (part == kOver) bounds.over_min = min(bounds.over_min, reach.x);
    if (part == kOver) bounds.over_max = max(bounds.over_max, reach.y);
}

void write_node(uint id, Bounds bounds, uint owner, uint ancestor) {
    pool.client.nodes.at[id].near_max = bounds.near_max;
    pool.client.nodes.at[id].far_min = bounds.far_min;
    pool.client.nodes.at[id].over_min = bounds.over_min;
    pool.client.nodes.at[id].over_max = bounds.over_max;
    pool.client.nodes.at[id].min_depth = bounds.min_depth;
    pool.client.nodes.at[id].ancestor = ancestor;
    if (owner == kRootOwner) pool.client.header.header.root = id + 1;
    else if (owner % 4 == kNear) pool.client.nodes.at[owner / 4].near = id + 1;
    else if (owner % 4 == kFar) pool.client.nodes.at[owner / 4].far = id + 1;
    else pool.client.nodes.at[owner / 4].over = id + 1;
}

void reach_depth(uint depth) {
    if (subgroupElect()) atomicMax(pool.client.header.header.depth_max, depth);
}

#include "taskpool/primitives/lanes.glsl"
#include "structures/metric_tree/median_partition.glsl"
#include "structures/metric_tree/median_choice.glsl"
#include "structures/metric_tree/median_leaf.glsl"

// ---- A range's way through its phases -------------------------------------------------------------

/// Whether the parts are smaller than the whole by enough to bound the depth; of few elements, the
/// pivot alone is enough.
bool progresses(Task task) {
    const uint others = task.range.count - 1;
    const uint largest = max(max(task.counts[0], task.counts[1]), task.counts[2]);
    return task.range.count <= kChainElements || largest + others / 32 <= others;
}

uint first_phase(Range range) {
    return range.count <= kLeafRange ? kPhaseLeaf : kPhaseChoose;
}

/// What follows upon a phase; ranges of one chunk are classified as soon as there is a pivot.
uint following(inout Task task, uint phase) {
    if (phase == kPhaseChoose && is_large(task.range)) return kPhaseClassify;
    if (phase > kPhaseClassify) return phase == kPhasePartition ? kPhaseSpawn : kPhaseEnd;
    const bool listed = task.attempt == kTries;
    if (!listed && !progresses(task)) {
        ++task.attempt;
        return kPhaseChoose;
    }
    if (subgroupElect())
        write_node(task.node, task.bounds, task.range.owner, task.range.ancestor);
    return listed ? kPhaseList : kPhasePartition;
}

Range range_of_part(Task task, uint part) {
    const Range whole = task.range;
    uint first = whole.first + 1;
    if (part > kNear) first += task.counts[kNear];
    if (part > kFar) first += task.counts[kFar];
    return Range(first, task.counts[part], 1 - whole.side, 4 * task.node + part,
                 part == kOver ? task.node + 1 : whole.ancestor, whole.depth + 1);
}

/// Ranges of a subtree that wait; disjoint, so there are no more than elements.
shared Range waiting[kSubtreeElements];

// ---- Hooks ----------------------------------------------------------------------------------------

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    const uint begin = task.range.first + chunk * kChunkElements;
    const uint end = chunk + 1 == chunk_count(task.range.count)
                         ? task.range.first + task.range.count : begin + kChunkElements;
    if (phase <= kPhaseGather) {
        gather_chunk(begin, end, phase == kPhaseCount);
        return;
    }
    const bool whole = task.range.count <= kSubtreeElements;
    uint waiting_count = 0;
    do {
        pool_spend(kTurnIterations);  // as the loops that this turn passes over count, too
        const uint from = whole ? task.range.first : begin;
        const uint to = whole ? task.range.first + task.range.count : end;
        if (phase == kPhaseChoose) choose(task);
        if (phase == kPhaseClassify || (phase == kPhaseChoose && !is_large(task.range)))
            classify_chunk(task, from, to);
        if (phase == kPhasePartition) partition_chunk(task, from, to);
        if (phase == kPhaseList) list_chunk(task, from, to);
        if (phase == kPhaseLeaf) build_leaf(task.range);
        if (!whole) return;

        pool_order_lanes();  // the next turn reads what other lanes wrote
        phase = following(task, phase);
        if (phase == kPhaseSpawn)
            [[unroll]] for (uint part = 0; part < 3; ++part)
                if (task.counts[part] > 0) {
                    if (subgroupElect()) waiting[waiting_count] = range_of_part(task, part);
                    ++waiting_count;
                }
        subgroup_sync();
        if (phase >= kPhaseSpawn && waiting_count > 0) {
            task = task_of(waiting[--waiting_count]);
            phase = first_phase(task.range);
        }
    } while (phase < kPhaseSpawn);
    task.range.count = 0;
}

/// Of large ranges, what their chunks found out; then on to the next phase.
Next finish_step(inout Task task, uint phase, uint step) {
    if (task.range.count == 0) return next_end();
    if (phase == kPhaseCount) {
        const uint found = scan_elements(task.range);
        if (subgroupElect()) pool.client.header.header.inserted = found;
        if (found == 0) return next_end();
        task.counts[0] = found;
        return next_step(kPhaseGather, 0, chunk_count(task.range.count));
    }
    if (phase == kPhaseGather) {
        task = task_of(Range(0, task.counts[0], 0, kRootOwner, 0, 1));
        return next_step(first_phase(task.range), 0, 1);
    }
    if (phase == kPhaseClassify) take_tally(task);
    const uint next = following(task, phase);
    if (next == kPhaseEnd) return next_end();
    if (next == kPhaseSpawn)
        return next_spawn(min(task.counts[0], 1u) + min(task.counts[1], 1u) + min(task.counts[2], 1u));
    return next_step(next, 0, next == kPhaseChoose ? 1 : chunk_count(task.range.count));
}

Task spawn_child(Task parent, uint child, out Start start) {
    // Empty parts are passed over.
    uint part = kNear;
    if (parent.counts[kNear] == 0 || child > 0) {
        if (parent.counts[kNear] > 0) --child;
        part = parent.counts[kFar] == 0 || child > 0 ? kOver : kFar;
    }
    Task task = task_of(range_of_part(parent, part));
    start = Start(first_phase(task.range), 0, 1, 0);
    // A large range begins with chunks that others may take.
    if (is_large(task.range)) {
        choose(task);
        start = Start(kPhaseClassify, 0, chunk_count(task.range.count), 0);
    }
    return task;
}
void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
