// Sum of an array by fork and join: a task forks two halves and waits; small ranges are summed in
// log steps (stride 1, 2, 4, ... within a run of kBlock values); joins add the two halves' sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"

const uint kBlock = 1024;
const uint kPhaseFork = 0, kPhaseEmpty = 1, kPhaseSteps = 2, kPhaseJoin = 3;

struct Task {
    uint first, count;
};
struct Client {
    PoolUints values;
};
#include "taskpool/pool/pool.glsl"

/// Pairs (i, i + stride) of the range, i a multiple of 2 * stride.
uint pair_count(Task task, uint stride) {
    return task.count <= stride ? 0 : (task.count - stride + 2 * stride - 1) / (2 * stride);
}

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    PoolUints values = pool.client.values;
    if (phase == kPhaseSteps) {
        const uint stride = 1u << step;
        const uint pair = chunk * gl_SubgroupSize + gl_SubgroupInvocationID;
        if (pair < pair_count(task, stride)) {
            const uint i = task.first + pair * 2 * stride;
            values.at[i] += values.at[i + stride];
        }
    }
    if (phase == kPhaseJoin && subgroupElect())
        values.at[task.first] += values.at[task.first + task.count / 2];
}

Next finish_step(inout Task task, uint phase, uint step) {
    if (phase == kPhaseFork)
        return task.count > kBlock ? next_spawn_and_wait(2, kPhaseJoin, 0, 1)
                                   : next_step(kPhaseEmpty, 0, 0);
    if (phase == kPhaseEmpty) step = 0xffffffffu;  // a phase without chunks leads on to the first step
    if (phase == kPhaseEmpty || phase == kPhaseSteps) {
        const uint pairs = pair_count(task, 1u << (step + 1));
        if (pairs > 0)
            return next_step(kPhaseSteps, step + 1, (pairs + gl_SubgroupSize - 1) / gl_SubgroupSize);
    }
    return next_end();
}

Task spawn_child(Task parent, uint child, out Start start) {
    start = Start(kPhaseFork, 0, 0, 0);
    const uint half_count = parent.count / 2;
    return child == 0 ? Task(parent.first, half_count)
                      : Task(parent.first + half_count, parent.count - half_count);
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
