// Quicksort-like partition of keys, by bisection of the value range. Exercises shared steps, private
// tasks, spawns without slots, and an output list that fills up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"

const uint kChunk = 256;
const uint kLeaf = 8;
const uint kPhasePartition = 0, kPhaseLeaf = 1;

struct Task {
    uint first, count;
    uint low, high;  // values of the keys, inclusive
    uint side;       // which of the two key buffers holds them
    uint below;      // after the partition: keys up to the pivot
};
struct Client {
    PoolUints keys[2];
    PoolUints cursors;  // two words at `first` of each task: keys below and above the pivot
    PoolUints leaves;   // word 0: count; then one word per leaf
    uint leaf_capacity;
};
#include "taskpool/pool/pool.glsl"

uint pivot(Task task) { return task.low + (task.high - task.low) / 2; }
uint chunk_count(uint count) { return (count + kChunk - 1) / kChunk; }
bool is_leaf(Task task) { return task.count <= kLeaf || task.low == task.high; }

/// All lanes get a run of `amount` counters.
uint reserve(uint word, uint amount) {
    uint before = 0;
    if (subgroupElect()) before = atomicAdd(pool.client.cursors.at[word], amount);
    return subgroupBroadcastFirst(before);
}

void partition_chunk(Task task, uint chunk) {
    PoolUints source = pool.client.keys[task.side], target = pool.client.keys[1 - task.side];
    const uint begin = task.first + chunk * kChunk;
    const uint end = min(begin + kChunk, task.first + task.count);
    const uint split = pivot(task);
    uint below = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        below += subgroupBallotBitCount(subgroupBallot(mine < end && source.at[mine] <= split));
    }
    uint low = task.first + reserve(task.first, below);
    uint high = task.first + task.count - reserve(task.first + 1, end - begin - below);
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const uint key = mine < end ? source.at[mine] : 0;
        const uvec4 lows = subgroupBallot(mine < end && key <= split);
        const uvec4 highs = subgroupBallot(mine < end && key > split);
        if (mine < end) {
            if (key <= split) target.at[low + subgroupBallotExclusiveBitCount(lows)] = key;
            else target.at[high - 1 - subgroupBallotExclusiveBitCount(highs)] = key;
        }
        low += subgroupBallotBitCount(lows);
        high -= subgroupBallotBitCount(highs);
    }
    pool_spend(2 * kChunk / gl_SubgroupSize);
}

/// Brings a leaf to buffer 0: equal keys as they are, a chunk at a time; others by one lane's
/// insertion sort.
void sort_leaf(Task task, uint chunk) {
    PoolUints source = pool.client.keys[task.side], target = pool.client.keys[0];
    if (task.low == task.high) {
        const uint begin = task.first + chunk * kChunk;
        const uint end = min(begin + kChunk, task.first + task.count);
        for (uint i = begin + gl_SubgroupInvocationID; i < end; i += gl_SubgroupSize)
            target.at[i] = source.at[i];
        pool_spend(kChunk / gl_SubgroupSize);
        return;
    }
    pool_spend(task.count * task.count);
    if (!subgroupElect()) return;
    for (uint i = 0; i < task.count; ++i) {
        const uint key = source.at[task.first + i];
        uint j = i;
        for (; j > 0 && target.at[task.first + j - 1] > key; --j)
            target.at[task.first + j] = target.at[task.first + j - 1];
        target.at[task.first + j] = key;
    }
}

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    if (phase == kPhasePartition) partition_chunk(task, chunk);
    else sort_leaf(task, chunk);
}

Next finish_step(inout Task task, uint phase, uint step) {
    if (phase == kPhasePartition) {
        if (is_leaf(task))
            return next_step(kPhaseLeaf, 0, task.low == task.high ? chunk_count(task.count) : 1);
        task.below = pool.client.cursors.at[task.first];
        return next_spawn(2);
    }
    // Append to the list of leaves, unless it is full.
    uint place = 0;
    if (subgroupElect()) {
        place = atomicAdd(pool.client.leaves.at[0], 1u);
        if (place >= pool.client.leaf_capacity) atomicAdd(pool.client.leaves.at[0], 0xffffffffu);
        else pool.client.leaves.at[1 + place] = task.first;
    }
    place = subgroupBroadcastFirst(place);
    if (place >= pool.client.leaf_capacity) return next_blocked();
    pool_progress(task.count);
    return next_end();
}

Task spawn_child(Task parent, uint child, out Start start) {
    Task task = parent;
    task.side = 1 - parent.side;
    if (child == 0) {
        task.count = parent.below;
        task.high = pivot(parent);
    } else {
        task.first += parent.below;
        task.count -= parent.below;
        task.low = pivot(parent) + 1;
    }
    if (task.count > 1 && subgroupElect())
        pool.client.cursors.at[task.first] = pool.client.cursors.at[task.first + 1] = 0;
    start = Start(kPhasePartition, 0, is_leaf(task) ? 0 : chunk_count(task.count), 0);
    return task;
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
