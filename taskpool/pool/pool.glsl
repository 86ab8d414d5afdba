// The task pool engine: persistent subgroups that run the chunks of tasks.
//
// Vinkler, Bittner and Havran, "Massively Parallel Hierarchical Scene Processing with Applications in
// Rendering", 2013, section 3. A task owns a contiguous range of data and runs through phases; a
// phase runs in steps; a step is cut into chunks, one subgroup each. The subgroup that finishes a
// step's last chunk runs the task's transition.
//
// A client kernel is this file between its types and its hooks:
//
//     #include "taskpool/pool/pool_types.glsl"
//     struct Task { uint first, count; };              // payload; constant while a step is shared
//     struct Client { ResultArray results; };          // at most 48 bytes, pushed with every launch
//     #include "taskpool/pool/pool.glsl"
//     void run_chunk(inout Task task, uint phase, uint step, uint chunk) { ... }
//     Next finish_step(inout Task task, uint phase, uint step) { return next_end(); }
//     Task spawn_child(Task parent, uint child, out Start start) { ... }
//     void spawned(Task parent, uint child, uint slot) {}
//     void end_task(Task task) {}
//
// Departures from the paper, all for drivers that promise no progress between workgroups:
// - nothing waits: a subgroup that finds no work polls within its budget and leaves; what it holds
//   (private tasks, claimed chunks, spawns without a slot) stays in buffers for the next launch;
// - a claim is a compare-and-swap, so a header never overshoots;
// - `Task` must not change while a step is shared between subgroups: results of shared chunks go to
//   client buffers. pool_alone() tells a hook that this subgroup runs all chunks of the step.

const uint kNextStep = 0, kNextSpawn = 1, kNextEnd = 2, kNextBlocked = 3;

/// What a transition decides; made by the next_...() functions.
struct Next {
    uint kind;
    uint phase, step, chunks;
    uint children;
    uint join;
};

/// How a spawned task begins: its first step, and how many pool_release() calls it waits for.
struct Start {
    uint phase, step, chunks;
    uint wait_count;
};

struct PoolEntry {
    TaskInfo info;
    Task task;
};

pool_buffer(4) PoolTasks { Task at[]; };
pool_buffer(4) PoolInfos { TaskInfo at[]; };
pool_buffer(4) PoolEntries { PoolEntry at[]; };
pool_buffer(8) PoolTrace { TraceRecord at[]; };
pool_buffer(4) PoolStateRef { PoolState state; };

layout(push_constant, scalar) uniform Push {
    PoolInts headers;
    PoolInfos infos;
    PoolTasks tasks;
    PoolInts unfinished;
    PoolUints maps;
    uint64_t stacks;
    PoolStateRef state;
    PoolTrace trace;
    uint capacity;
    uint iteration_budget;
    uint time_budget_us;
    uint trace_capacity;
    Client client;
} pool;

// ---- Hooks, defined by the client ---------------------------------------------------------------

/// Runs chunk `chunk` of the step with all lanes. May change `task` only if pool_alone().
void run_chunk(inout Task task, uint phase, uint step, uint chunk);
/// Run once when every chunk of the step is done, with all their writes visible.
Next finish_step(inout Task task, uint phase, uint step);
/// The child-th child, last child first; called again later if there is no slot for it now. The first
/// child takes over the parent's slot if the parent does not wait.
Task spawn_child(Task parent, uint child, out Start start);
/// Child `child` was placed in `slot` (kNoSlot: it is private to this subgroup and waits for nothing).
void spawned(Task parent, uint child, uint slot);
/// The task is over; the place for pool_release() of tasks that wait for this one.
void end_task(Task task);

Next next_step(uint phase, uint step, uint chunks) {
    return Next(kNextStep, phase, step, chunks, 0, 0);
}
/// Spawns `children` tasks and ends this one.
Next next_spawn(uint children) { return Next(kNextSpawn, 0, 0, 0, children, 0); }
/// Spawns `children` tasks and goes on with the given step when they all have ended.
Next next_spawn_and_wait(uint children, uint phase, uint step, uint chunks) {
    return Next(kNextSpawn, phase, step, chunks, children, 1);
}
Next next_end() { return Next(kNextEnd, 0, 0, 0, 0, 0); }
/// An output buffer is full: the transition is tried again after the host has grown it.
Next next_blocked() { return Next(kNextBlocked, 0, 0, 0, 0, 0); }

#include "taskpool/pool/context.glsl"
#include "taskpool/pool/policy.glsl"

// ---- Private stack: what this subgroup holds between chunks and between launches ------------------

PoolEntries pool_stack() {
    const uint64_t counts = uint64_t((gl_NumWorkGroups.x * 4 + 15) & ~15u);
    const uint64_t bytes = uint64_t(kStackDepth) * uint64_t(kEntryBytes);
    return PoolEntries(pool.stacks + counts + uint64_t(gl_WorkGroupID.x) * bytes);
}

void stack_push(TaskInfo info, Task task) {
    if (subgroupElect()) {
        pool_stack().at[pool_held].info = info;
        pool_stack().at[pool_held].task = task;
    }
    ++pool_held;
    pool_order_lanes();
}

void stack_pop(out TaskInfo info, out Task task) {
    --pool_held;
    info = pool_stack().at[pool_held].info;
    task = pool_stack().at[pool_held].task;
}

// ---- Publishing and releasing --------------------------------------------------------------------

/// Puts the task, ready or waiting, into `slot`, which the caller owns (its header is locked).
void publish(uint slot, TaskInfo info, Task task, int wait_count) {
    info.home = slot;
    flush_live(0);
    if (subgroupElect()) {
        pool.tasks.at[slot] = task;
        pool.infos.at[slot] = info;
        // A step without chunks is published as one empty chunk: whoever claims it transitions.
        pool.unfinished.at[slot] = int(max(info.chunk_count, 1u));
    }
    pool_order_lanes();
    ++pool_counters.published;
    if (wait_count > 0)
        pool_store(pool.headers, slot, -wait_count);
    else
        activate(slot, int(max(info.chunk_count, 1u)));
}

/// One of the tasks that the task in `slot` waits for is over; the last one makes it active.
void pool_release(uint slot) {
    if (pool_add(pool.headers, slot, 1) == -1)
        activate(slot, max(pool.unfinished.at[slot], 1));
}

#include "taskpool/pool/run.glsl"
