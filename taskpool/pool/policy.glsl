// Scheduling policies: how a subgroup finds work and free slots. One interface, two policies,
// chosen by the specialisation constant kPolicy:
//
//     bool find_active(out uint slot, out int chunks)   some slot that looks claimable
//     uint allocate_slot()                              a locked slot, or kNoSlot
//     void activate(slot, chunks)                       makes a locked or waiting slot claimable
//     void drained(slot)                                its last chunk was claimed
//     void free_slot(slot)
//
// kPolicyScan is the paper's (section 3.1): all lanes look at a run of headers. kPolicyBitmap keeps
// one bit per slot for "active" and "empty" and one bit per word above: 8 lanes look at 8192 slots
// at once. A bit is a hint; only the header decides.

uint map_words() { return (pool.capacity + 31) / 32; }
uint map_top_words() { return (map_words() + 31) / 32; }
/// First word of a map: its top level, then its bottom level.
uint map_top(uint map) { return map * (map_words() + map_top_words()); }
uint map_bottom(uint map) { return map_top(map) + map_top_words(); }

void map_set(uint map, uint slot) {
    const uint word = slot / 32;
    if (map_or(map_bottom(map) + word, 1u << (slot % 32)) == 0)
        map_or(map_top(map) + word / 32, 1u << (word % 32));
}

/// Clears the slot's bit; true if it was set, that is, if this subgroup took it.
bool map_clear(uint map, uint slot) {
    const uint bit = 1u << (slot % 32);
    return (map_and(map_bottom(map) + slot / 32, ~bit) & bit) != 0;
}

/// The set bit of `bits` that comes `turn`-th (modulo their number).
uint pick_bit(uint bits, uint turn) {
    for (uint skip = turn % uint(bitCount(bits)); skip > 0; --skip) {
        bits &= bits - 1;
        ++pool_iterations;
    }
    return uint(findLSB(bits));
}

/// Value of `mine` in the lane that is the pick-th of `candidates` to say yes.
uint from_lane(bool yes, uint mine, out bool any) {
    const uvec4 ballot = subgroupBallot(yes);
    const uint count = subgroupBallotBitCount(ballot);
    any = count > 0;
    if (!any) return 0;
    const uint turn = gl_WorkGroupID.x % count;
    const uvec4 mine_is_it =
        subgroupBallot(yes && subgroupBallotExclusiveBitCount(ballot) == turn);
    return subgroupShuffle(mine, subgroupBallotFindLSB(mine_is_it));
}

/// A set bit of the map, near the hint; kNoSlot if a look at one run of top words showed none.
uint map_find(uint map, inout uint hint) {
    const uint tops = map_top_words();
    hint = hint < tops ? hint : 0;
    const uint mine = hint + gl_SubgroupInvocationID;
    const uint top = mine < tops ? map_peek(map_top(map) + mine) : 0u;
    ++pool_counters.polls;
    bool any;
    const uint top_word = from_lane(top != 0, mine, any);
    if (!any) {
        hint += gl_SubgroupSize;
        return kNoSlot;
    }
    const uint bits = subgroupShuffle(top, top_word - hint);
    const uint word = top_word * 32 + pick_bit(bits, gl_WorkGroupID.x);
    const uint slots = subgroupBroadcastFirst(map_peek(map_bottom(map) + word));
    if (slots != 0) return word * 32 + pick_bit(slots, gl_WorkGroupID.x);
    // The word has drained. Clear its bit above, then look again: a setter that saw the word empty
    // sets the bit after us, and one that came before us shows in this second look.
    const uint top_bit = 1u << (word % 32);
    map_and(map_top(map) + top_word, ~top_bit);
    if (subgroupBroadcastFirst(map_peek(map_bottom(map) + word)) != 0)
        map_or(map_top(map) + top_word, top_bit);
    return kNoSlot;
}

/// Looks at the next run of headers; the slot of this subgroup's turn whose header passes.
uint scan_headers(bool want_empty, uint end, inout uint hint) {
    hint = hint < end ? hint : 0;
    const uint mine = hint + gl_SubgroupInvocationID;
    const int header = mine < end ? header_peek(mine) : 0;
    ++pool_counters.polls;
    bool any;
    const uint slot = from_lane(want_empty ? header == kEmpty : header > 0, mine, any);
    if (any) return slot;
    hint += gl_SubgroupSize;
    return kNoSlot;
}

bool find_active(out uint slot, out int chunks) {
    slot = kPolicy == kPolicyScan ? scan_headers(false, slots_in_use(), pool_hint)
                                  : map_find(kActiveMap, pool_hint);
    if (slot == kNoSlot) return false;
    chunks = subgroupBroadcastFirst(header_peek(slot));
    return chunks > 0;
}

uint allocate_slot() {
    // Within one call, look everywhere once: the caller decides what to do when all is full.
    const uint looks = min(kMaxLooks, kPolicy == kPolicyScan
                                          ? pool.capacity / gl_SubgroupSize + 2
                                          : map_top_words() / gl_SubgroupSize + 34);
    for (uint look = 0; look < looks; ++look) {
        ++pool_iterations;
        uint slot;
        bool taken = false;
        if (kPolicy == kPolicyScan) {
            slot = scan_headers(true, pool.capacity, pool_free_hint);
            if (slot != kNoSlot) taken = pool_swap(pool.headers, slot, kEmpty, 0) == kEmpty;
        } else {
            slot = map_find(kEmptyMap, pool_free_hint);
            if (slot != kNoSlot) {
                taken = map_clear(kEmptyMap, slot);
                if (taken) pool_store(pool.headers, slot, 0);
            }
        }
        if (taken) {
            if (slot >= pool_counters.high_water) {
                pool_counters.high_water = slot + 1;
                if (subgroupElect()) atomicMax(pool.state.state.high_water, slot + 1);
            }
            return slot;
        }
    }
    return kNoSlot;
}

void activate(uint slot, int chunks) {
    pool_store(pool.headers, slot, chunks);
    if (kPolicy == kPolicyBitmap) map_set(kActiveMap, slot);
}

void drained(uint slot) {
    if (kPolicy == kPolicyBitmap) map_clear(kActiveMap, slot);
}

void free_slot(uint slot) {
    pool_store(pool.headers, slot, kEmpty);
    if (kPolicy == kPolicyBitmap) map_set(kEmptyMap, slot);
}

/// Claims chunks [first, first + count) of some task. The paper takes max(S / W + 1, K) of them, S
/// the chunks it sees and W the subgroups.
bool claim(out uint slot, out uint first, out uint count) {
    int available;
    if (!find_active(slot, available)) return false;
    const uint share = uint(available) / gl_NumWorkGroups.x + 1;
    count = min(uint(available), max(share, kMinChunks));
    if (pool_swap(pool.headers, slot, available, available - int(count)) != available) {
        ++pool_counters.failed_claims;
        return false;
    }
    ++pool_counters.claims;
    if (uint(available) == count) drained(slot);
    // The header counts down, chunks are numbered up from the task's first one.
    first = pool.infos.at[slot].chunk_count - uint(available);
    return true;
}
