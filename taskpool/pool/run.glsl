// The engine's loop. A subgroup is idle, runs claimed chunks of a shared step, or owns a task: it
// alone runs its chunks, its transition and its spawns. Each hook has one call site: hooks are inlined.

const uint kIdle = 0, kClaimed = 1, kOwned = 2;

uint pool_mode = kIdle;
uint pool_slot;        // kClaimed: the slot whose chunks [pool_chunk, pool_chunk_end) are ours
uint pool_chunk, pool_chunk_end, pool_claimed;
// Something on the private stack waits for a slot, or for a larger output buffer, and nothing has
// changed since it was last tried.
bool pool_stalled = false, pool_blocked = false;

/// Polls in vain after which a subgroup that holds something stalled leaves: the host can help.
const uint kStalledPolls = 64;

/// Takes up work: a private task first (unless it is stalled), then the pool's.
void find_work(inout TaskInfo info, inout Task task) {
    if (pool_held > 0 && !pool_stalled && !pool_blocked) {
        stack_pop(info, task);
        if (info.state != kStateClaim) {
            pool_mode = kOwned;
            return;
        }
        pool_slot = info.parent;
        pool_chunk = info.next_chunk;
        pool_chunk_end = info.chunk_count;
        pool_claimed = info.spawn_count;
    } else {
        // Room must remain for what is stalled next, and for what is in hand at the end.
        if (pool_held + 2 >= kStackDepth) return;
        if (!claim(pool_slot, pool_chunk, pool_claimed)) return;
        pool_chunk_end = pool_chunk + pool_claimed;
    }
    info = pool.infos.at[pool_slot];
    task = pool.tasks.at[pool_slot];
    // A step published without chunks has one empty chunk to claim.
    if (info.chunk_count == 0) pool_chunk = pool_chunk_end;
    pool_mode = kClaimed;
    // Whoever claims a whole step owns the task.
    if (pool_claimed == max(info.chunk_count, 1u)) {
        info.home = pool_slot;
        info.next_chunk = pool_chunk;
        pool_mode = kOwned;
    }
}

/// Work was done: what is stalled may be tried again.
void become_idle() {
    pool_mode = kIdle;
    pool_stalled = false;
    pool_blocked = false;
}

/// Leaves the task: its slot becomes free, whoever waits for it learns of it.
void finish_task(TaskInfo info, Task task) {
    end_task(task);
    if (info.parent != kNoSlot) pool_release(info.parent);
    if (info.home != kNoSlot) free_slot(info.home);
    --pool_live_delta;
    if (pool_held == 0) flush_live(0);
    become_idle();
}

/// Puts the task aside until something changes.
void put_aside(TaskInfo info, Task task) {
    stack_push(info, task);
    pool_mode = kIdle;
}

void transition(inout TaskInfo info, inout Task task) {
    const Next next = finish_step(task, info.phase, info.step);
    if (next.kind == kNextBlocked) {
        put_aside(info, task);
        pool_blocked = true;
        return;
    }
    if (next.kind == kNextEnd) {
        finish_task(info, task);
        return;
    }
    info.phase = next.phase;
    info.step = next.step;
    info.next_chunk = 0;
    info.chunk_count = next.chunks;
    if (next.kind == kNextSpawn) {
        info.state = kStateSpawn;
        info.spawn_next = next.children;  // counts down: child 0 comes last and may reuse the slot
        info.spawn_count = next.children;
        info.join = next.join;
        return;
    }
    info.state = kStateRun;
    // Small steps are run at once; a private task stays private.
    if (next.chunks >= kMinChunks && info.home != kNoSlot) {
        publish(info.home, info, task, 0);
        become_idle();
    }
}

/// Places the next child, or ends the spawning. False if no slot was found.
bool spawn_next_child(inout TaskInfo info, inout Task task) {
    // Children address a waiting parent by its slot.
    if (info.join != 0 && info.home == kNoSlot) {
        info.home = allocate_slot();
        if (info.home == kNoSlot) return false;
    }
    // Waits for its children, and for itself to be done spawning them.
    if (info.join != 0 && info.spawn_next == info.spawn_count)
        pool_store(pool.headers, info.home, -int(info.spawn_count) - 1);

    if (info.spawn_next == 0) {
        info.state = kStateRun;
        if (info.join == 0) {
            finish_task(info, task);  // its slot was no child's: there was none, or child 0 waits
            return true;
        }
        if (subgroupElect()) {
            pool.tasks.at[info.home] = task;
            pool.infos.at[info.home] = info;
            pool.unfinished.at[info.home] = int(max(info.chunk_count, 1u));
        }
        pool_release(info.home);
        become_idle();
        return true;
    }
    const uint child = info.spawn_next - 1;
    Start start;
    const Task payload = spawn_child(task, child, start);
    TaskInfo child_info = TaskInfo(kStateRun, start.phase, start.step, start.chunks, 0,
                                   info.join != 0 ? info.home : kNoSlot, 0, 0, 0, kNoSlot);
    const bool is_private = start.chunks < kPrivateChunks && start.wait_count == 0;
    const bool push = is_private && pool_held + 2 < kStackDepth;

    if (child == 0 && info.join == 0 && start.wait_count == 0) {
        // The last child becomes what this subgroup owns.
        end_task(task);
        if (info.parent != kNoSlot) pool_release(info.parent);
        spawned(task, child, info.home);
        child_info.home = info.home;
        info = child_info;
        task = payload;
        ++pool_counters.spawned;
        if (start.chunks >= kMinChunks && info.home != kNoSlot) {
            publish(info.home, info, task, 0);
            become_idle();
        }
        return true;
    }
    if (push) {
        spawned(task, child, kNoSlot);
        stack_push(child_info, payload);
        ++pool_live_delta;
        ++pool_counters.spawned_private;
    } else {
        const uint slot = allocate_slot();
        if (slot == kNoSlot) return false;
        flush_live(1);
        spawned(task, child, slot);
        publish(slot, child_info, payload, int(start.wait_count));
    }
    ++pool_counters.spawned;
    info.spawn_next = child;
    return true;
}

/// Whether the driver has cut a loop: each one ends after its first turn from then on. This one takes
/// two turns, a number that no compiler knows.
bool loops_are_cut() {
    const uint turns = 2 + pool.capacity % 2;
    uint turn = 0;
    while (turn < turns) ++turn;
    return turn < turns;
}

void main() {
    pool_began = pool_clock();
    pool_counters = PoolState(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, uint[kPhaseCounters](
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
    // Subgroups begin their search apart, and each launch where the last one came to: a budget may be
    // too small for a look at all slots.
    pool_hint = (subgroupBroadcastFirst(pool.state.state.polls) * gl_SubgroupSize +
                 gl_WorkGroupID.x * (slots_in_use() / gl_NumWorkGroups.x)) % slots_in_use();
    // Beyond the slots in use there are sure to be free ones.
    if (kPolicy == kPolicyScan) pool_free_hint = slots_in_use();
    pool_held = PoolUints(pool.stacks).at[gl_WorkGroupID.x];
    TaskInfo info;
    Task task;
    uint idle = 0;
    uint since_clock = 0;

    while (pool_iterations + kChunkIterations + kTurnIterations < pool.iteration_budget) {
        pool_iterations += kTurnIterations;
        if (++since_clock >= 64) {
            since_clock = 0;
            if (microseconds_since(pool_began) > pool.time_budget_us) break;
        }
        if (pool_mode == kIdle) {
            find_work(info, task);
            if (pool_mode == kIdle) {
                if (++idle > kIdlePolls || live_tasks() == 0) break;
                // With a stalled spawn in hand, leave as soon as nobody else has work to offer.
                if (pool_held > 0 && idle > kStalledPolls) break;
                continue;
            }
            idle = 0;
        }
        if (pool_mode == kOwned && info.state == kStateSpawn) {
            if (!spawn_next_child(info, task)) {
                put_aside(info, task);
                pool_stalled = true;
            }
            continue;
        }
        const bool owned = pool_mode == kOwned;
        uint chunk = owned ? info.next_chunk : pool_chunk;
        const uint end = owned ? info.chunk_count : pool_chunk_end;
        if (chunk < end) {
            pool_is_alone = owned;
            uint begin;
            if (kTrace) begin = pool_clock();
            run_chunk(task, info.phase, info.step, chunk);
            pool_order_lanes();
            if (kTrace) trace_chunk(owned ? info.home : pool_slot, info.phase, info.step, begin);
            ++pool_counters.chunks;
            ++pool_counters.phase_chunks[min(info.phase, kPhaseCounters - 1)];
            ++chunk;
            if (owned) info.next_chunk = chunk;
            else pool_chunk = chunk;
            if (chunk < end) continue;
        }
        if (!owned) {
            const int left = pool_add(pool.unfinished, pool_slot, -int(pool_claimed));
            become_idle();
            if (left != int(pool_claimed)) continue;
            pool_mode = kOwned;
            info.home = pool_slot;
            info.next_chunk = info.chunk_count;
        }
        transition(info, task);
    }

    if (idle > kStalledPolls || pool_counters.chunks == 0) {
        pool_counters.stalled = pool_stalled ? 1 : 0;
        pool_counters.blocked = pool_blocked ? 1 : 0;
    }
    // What is in hand stays with this subgroup until the next launch.
    if (pool_mode == kOwned) stack_push(info, task);
    if (pool_mode == kClaimed)
        stack_push(TaskInfo(kStateClaim, 0, 0, pool_chunk_end, pool_chunk, pool_slot, 0, pool_claimed,
                            0, kNoSlot), task);
    flush_live(0);
    pool_counters.cut = loops_are_cut() ? 1 : 0;
    flush_counters();
    if (subgroupElect()) PoolUints(pool.stacks).at[gl_WorkGroupID.x] = pool_held;
}
