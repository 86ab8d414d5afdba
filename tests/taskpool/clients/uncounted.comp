// A client that breaks its promise: the iterations of its one loop are told to nobody.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"

struct Task {
    uint iterations;
};
struct Client {
    PoolUints counted;
};
#include "taskpool/pool/pool.glsl"

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    // A loop with an effect: its result cannot be had without it.
    uint hash = 0, count = 0;
    for (; count < task.iterations; ++count) hash = (hash ^ count) * 0x01000193u;
    if (subgroupElect()) {
        pool.client.counted.at[0] = count;
        pool.client.counted.at[1] = hash;
    }
}

Next finish_step(inout Task task, uint phase, uint step) { return next_end(); }

Task spawn_child(Task parent, uint child, out Start start) {
    start = Start(0, 0, 0, 0);
    return parent;
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
