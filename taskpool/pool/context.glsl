// What a subgroup knows about itself, and the atomics it speaks to others with.

PoolState pool_counters;      // this launch's, added to the shared ones at the end
uint pool_held = 0;           // entries on the private stack
bool pool_is_alone = false;
uint pool_iterations = 0;     // of the budget
uint pool_hint = 0;           // where this subgroup looks first for work
uint pool_free_hint = 0;      // and for a free slot
int pool_live_delta = 0;      // private tasks spawned less tasks ended, not yet told to the others
uint pool_began;

/// True in run_chunk while this subgroup runs all chunks of the step: results may stay in `task`.
bool pool_alone() { return pool_is_alone; }
/// To be called by hooks with the loop iterations they took, beyond one per chunk.
void pool_spend(uint iterations) { pool_iterations += iterations; }
/// Adds to the measure of progress that the host sees.
void pool_progress(uint amount) { pool_counters.progress += amount; }

/// Orders the lanes' accesses before to those after, also as seen from other subgroups.
void pool_order_lanes() {
    const int semantics =
        gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible;
    if (kLockstep)
        memoryBarrier(gl_ScopeDevice, gl_StorageSemanticsBuffer, semantics);
    else
        controlBarrier(gl_ScopeSubgroup, gl_ScopeDevice, gl_StorageSemanticsBuffer, semantics);
}

// Atomics on one word, done by one lane, with acquire and release order at device scope: what this
// subgroup wrote before is seen by whoever reads the word's new value, and the other way round.

int pool_add(PoolInts words, uint i, int value) {
    int before = 0;
    pool_order_lanes();
    if (subgroupElect())
        before = atomicAdd(words.at[i], value, gl_ScopeDevice, gl_StorageSemanticsBuffer,
                           gl_SemanticsAcquireRelease);
    before = subgroupBroadcastFirst(before);
    pool_order_lanes();
    return before;
}

int pool_swap(PoolInts words, uint i, int expected, int value) {
    int before = 0;
    pool_order_lanes();
    if (subgroupElect())
        before = atomicCompSwap(words.at[i], expected, value, gl_ScopeDevice,
                                gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease,
                                gl_StorageSemanticsBuffer, gl_SemanticsAcquire);
    before = subgroupBroadcastFirst(before);
    pool_order_lanes();
    return before;
}

void pool_store(PoolInts words, uint i, int value) {
    pool_order_lanes();
    if (subgroupElect())
        atomicStore(words.at[i], value, gl_ScopeDevice, gl_StorageSemanticsBuffer,
                    gl_SemanticsRelease);
}

// Every lane loads its own word; no order. Lanes that load the same word may still see different
// values: what must be uniform is broadcast from the first lane.

int header_peek(uint slot) {
    return atomicLoad(pool.headers.at[slot], gl_ScopeDevice, gl_StorageSemanticsNone,
                      gl_SemanticsRelaxed);
}
uint map_peek(uint word) {
    return atomicLoad(pool.maps.at[word], gl_ScopeDevice, gl_StorageSemanticsNone,
                      gl_SemanticsRelaxed);
}

uint map_or(uint word, uint bits) {
    uint before = 0;
    pool_order_lanes();
    if (subgroupElect())
        before = atomicOr(pool.maps.at[word], bits, gl_ScopeDevice, gl_StorageSemanticsBuffer,
                          gl_SemanticsAcquireRelease);
    return subgroupBroadcastFirst(before);
}

uint map_and(uint word, uint bits) {
    uint before = 0;
    if (subgroupElect())
        before = atomicAnd(pool.maps.at[word], bits, gl_ScopeDevice, gl_StorageSemanticsBuffer,
                           gl_SemanticsAcquireRelease);
    before = subgroupBroadcastFirst(before);
    pool_order_lanes();
    return before;
}

int live_tasks() {
    return subgroupBroadcastFirst(atomicLoad(pool.state.state.live, gl_ScopeDevice,
                                             gl_StorageSemanticsNone, gl_SemanticsRelaxed));
}
uint slots_in_use() {
    const uint high_water = subgroupBroadcastFirst(atomicLoad(
        pool.state.state.high_water, gl_ScopeDevice, gl_StorageSemanticsNone, gl_SemanticsRelaxed));
    return min(pool.capacity, high_water);
}

/// Tells the others about private tasks begun and tasks ended. Only when this subgroup holds nothing
/// may the sum become 0.
void flush_live(int extra) {
    const int delta = pool_live_delta + extra;
    pool_live_delta = 0;
    if (delta == 0) return;
    int before = 0;
    if (subgroupElect())
        before = atomicAdd(pool.state.state.live, delta, gl_ScopeDevice, gl_StorageSemanticsBuffer,
                           gl_SemanticsAcquireRelease);
    before = subgroupBroadcastFirst(before);
    pool_counters.peak_live = max(pool_counters.peak_live, before + delta);
}

/// Adds this launch's counters to the shared ones.
void flush_counters() {
    if (!subgroupElect()) return;
#define add_counter(name) \
    if (pool_counters.name != 0) atomicAdd(pool.state.state.name, pool_counters.name)
    add_counter(stalled);
    add_counter(blocked);
    add_counter(cut);
    add_counter(progress);
    add_counter(chunks);
    add_counter(claims);
    add_counter(failed_claims);
    add_counter(polls);
    add_counter(spawned);
    add_counter(spawned_private);
    add_counter(published);
    for (uint i = 0; i < kPhaseCounters; ++i) add_counter(phase_chunks[i]);
#undef add_counter
    atomicMax(pool.state.state.peak_live, pool_counters.peak_live);
    atomicMax(pool.state.state.high_water, pool_counters.high_water);
}

/// Device clock in nanoseconds (what all drivers that we know count in). Its upper half is left out:
/// lavapipe's clock has none. Differences are right across a wrap, up to four seconds.
uint pool_clock() { return clockRealtime2x32EXT().x; }

uint microseconds_since(uint begin) { return (pool_clock() - begin) / 1000; }

void trace_chunk(uint slot, uint phase, uint step, uint begin) {
    if (!subgroupElect()) return;
    const uint end = pool_clock();
    const uint i = atomicAdd(pool.state.state.trace_count, 1u);
    if (i < pool.trace_capacity)
        pool.trace.at[i] =
            TraceRecord(gl_WorkGroupID.x, slot, phase, step, begin, end);
}
