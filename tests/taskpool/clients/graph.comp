// A dependency graph: node v waits for its predecessors u < v. The root spawns all nodes, last first,
// so a node's successors have slots before it may run.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"

const uint kPhaseRoot = 0, kPhaseNode = 1;

struct Task {
    uint node;
};
struct Client {
    PoolUints first_successor;    // CSR: node -> range of `successors`
    PoolUints successors;
    PoolUints predecessor_count;
    PoolUints slot_of;
    PoolUints finished;           // word 0: how many are; word 1 + node: its place in the order
    uint node_count;
};
#include "taskpool/pool/pool.glsl"

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    if (phase != kPhaseNode || !subgroupElect()) return;
    pool.client.finished.at[1 + task.node] = atomicAdd(pool.client.finished.at[0], 1u) + 1;
}

Next finish_step(inout Task task, uint phase, uint step) {
    return phase == kPhaseRoot ? next_spawn(pool.client.node_count) : next_end();
}

Task spawn_child(Task parent, uint child, out Start start) {
    start = Start(kPhaseNode, 0, 1, pool.client.predecessor_count.at[child]);
    return Task(child);
}

void spawned(Task parent, uint child, uint slot) {
    if (subgroupElect()) pool.client.slot_of.at[child] = slot;
}

void end_task(Task task) {
    if (task.node >= pool.client.node_count) return;  // the root
    const uint end = pool.client.first_successor.at[task.node + 1];
    for (uint i = pool.client.first_successor.at[task.node]; i < end; ++i)
        pool_release(pool.client.slot_of.at[pool.client.successors.at[i]]);
    pool_spend(end - pool.client.first_successor.at[task.node]);
}
