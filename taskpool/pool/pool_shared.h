// What the engine (pool.glsl) and its host side (pool.hpp) both know: slot states, the records in
// the pool's buffers, and what a launch is told and tells back.
#include "taskpool/gpu/shared_types.h"

#ifdef __cplusplus
namespace taskpool::pool {
using namespace gpu::shared_types;
#define POOL_CONSTANT constexpr
#else
#define POOL_CONSTANT const
#endif

// Header of a slot (Vinkler, Bittner, Havran 2013, section 3): > 0 active, that many chunks are
// unclaimed; 0 locked: every chunk is claimed, or one subgroup owns the task; < 0 waiting for that
// many tasks; kEmpty: no task. The paper claims by an unconditional decrement and has to tell
// overshoots apart afterwards; a claim here is one compare-and-swap, so headers never overshoot.
POOL_CONSTANT int kEmpty = -0x40000000;
POOL_CONSTANT uint kNoSlot = 0xffffffffu;

// Scheduling policies.
POOL_CONSTANT uint kPolicyScan = 0;    // the paper's: look at runs of headers
POOL_CONSTANT uint kPolicyBitmap = 1;  // two-level bitmaps of active and empty slots, private tasks

POOL_CONSTANT uint kMaxLooks = 8192;  // for a free slot, in one go
POOL_CONSTANT uint kPhaseCounters = 16;  // phases from 15 on share the last counter

// Words of the bitmap buffer, per map: one bit per slot, and one bit per word above it.
POOL_CONSTANT uint kMapCount = 2;
POOL_CONSTANT uint kActiveMap = 0;
POOL_CONSTANT uint kEmptyMap = 1;

// How far a task has come.
POOL_CONSTANT uint kStateRun = 0;      // chunks [next_chunk, chunk_count), then its transition
POOL_CONSTANT uint kStateSpawn = 1;    // children [spawn_next, spawn_count) are still to be placed
POOL_CONSTANT uint kStateClaim = 2;    // not a task: claimed chunks of the task in slot `parent`

// The engine's part of a task; the client's part is its own struct Task.
struct TaskInfo {
    uint state;
    uint phase, step;
    uint chunk_count;
    uint next_chunk;
    uint parent;  // slot that waits for this task, or kNoSlot
    uint spawn_next, spawn_count;
    uint join;  // after spawning: 1 to wait for the children, 0 to end
    uint home;  // slot this task occupies, or kNoSlot while it is private to a subgroup
};

// Counters of a run and what the host must know between launches.
struct PoolState {
    int live;            // tasks that were spawned and have not ended
    int peak_live;
    uint high_water;     // slots [0, high_water) have been in use
    uint stalled;        // subgroups that left a launch with a spawn that found no slot
    uint blocked;        // subgroups that left with a task that waits for a larger output buffer
    uint cut;            // subgroups whose loops the driver cut: results are wrong
    uint progress;       // client's measure, see pool_progress()
    uint trace_count;    // trace records wanted; beyond the capacity they are only counted
    uint chunks, claims, failed_claims, polls;
    uint spawned, spawned_private, published;
    uint phase_chunks[kPhaseCounters];
};

struct TraceRecord {
    uint subgroup, slot, phase, step;
    uint begin, end;  // device clock in nanoseconds, modulo 2^32
};

#ifdef __cplusplus
static_assert(sizeof(TaskInfo) == 40);
static_assert(sizeof(PoolState) == 15 * 4 + kPhaseCounters * 4);
static_assert(sizeof(TraceRecord) == 24);

// Push constants of every pool kernel; the client's own struct Client follows.
struct PoolPush {
    std::uint64_t headers, infos, tasks, unfinished, maps, stacks, state, trace;
    uint capacity;
    uint iteration_budget;
    uint time_budget_us;
    uint trace_capacity;
};
static_assert(sizeof(PoolPush) == 80);
}  // namespace taskpool::pool
#endif
#undef POOL_CONSTANT
