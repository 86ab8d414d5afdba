// Memory that the chunks of a large task share. Disjoint ranges of more than kChunkPrimitives begin in
// different multiples of it, so where a range begins names its scratch: nothing is allocated.

const uint kAllBins = 3 * kBins;  // of the three axes
const uint kChildWord = kAllBins * kBinWords;  // four boxes of keys: see move_range()
const uint kScratchWords = kChildWord + 4 * kKeys;

uint scratch_word(uint first) { return first / kChunkPrimitives * kScratchWords; }

/// First of the kAllBins words that belong to the chunk [begin, end) alone: full chunks have theirs per
/// multiple of kChunkPrimitives, and so have shorter ones, the last of their tasks.
uint chunk_word(uint begin, uint end) {
    const uint all = (pool.client.mesh.data.triangle_count / kChunkPrimitives + 1) * kScratchWords;
    const uint chunk = 2 * (begin / kChunkPrimitives) + (end - begin < kChunkPrimitives ? 1 : 0);
    return all + chunk * kAllBins;
}

void clear_scratch(uint first) {
    for (uint i = gl_SubgroupInvocationID; i < kScratchWords; i += gl_SubgroupSize)
        pool.client.scratch.words[scratch_word(first) + i] = 0;
    pool_spend(kScratchWords / gl_SubgroupSize);
    pool_order_lanes();
}

/// Joins the boxes, which all lanes know, into the task's words from kChildWord on.
void flush_boxes(uint first, KeyBox boxes[4]) {
    if (!subgroupElect()) return;
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        const uint at = scratch_word(first) + kChildWord + i * kKeys;
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            atomicMax(pool.client.scratch.words[at + k], boxes[i].low[k]);
            atomicMax(pool.client.scratch.words[at + 3 + k], boxes[i].high[k]);
        }
    }
}

/// The task's words from kChildWord on.
void fetch_boxes(uint first, out KeyBox boxes[4]) {
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        const uint at = scratch_word(first) + kChildWord + i * kKeys;
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            boxes[i].low[k] = pool.client.scratch.words[at + k];
            boxes[i].high[k] = pool.client.scratch.words[at + 3 + k];
        }
    }
}

/// Exclusive scan over the chunks of a range, of the sum of each one's `words` words from `from` on;
/// leaves it in their first words and returns the sum of all.
uint scan_chunks(uint first, uint count, uint from, uint words) {
    uint sum = 0;
    for (uint i = 0; i * kChunkPrimitives < count; i += gl_SubgroupSize) {
        const uint chunk = i + gl_SubgroupInvocationID;
        const bool used = chunk * kChunkPrimitives < count;
        const uint begin = first + chunk * kChunkPrimitives;
        const uint word = chunk_word(begin, min(begin + kChunkPrimitives, first + count));
        uint mine = 0;
        [[unroll]] for (uint k = 0; k < kBins; ++k)
            mine += used && k < words ? pool.client.scratch.words[word + from + k] : 0;
        const uint to_here = sum_to_here(mine);
        if (used) pool.client.scratch.words[word] = sum + to_here - mine;
        sum += subgroupShuffle(to_here, kLanes - 1);
        pool_spend(1);
    }
    pool_order_lanes();
    return sum;
}

/// Joins this subgroup's bins into the task's. A chunk seldom extends them: look before the atomics.
void flush_bins(uint first, Bin bins[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint bin = bin_of_row(row);
        if (bin < kAllBins && bins[row].count > 0) {
            const uint at = scratch_word(first) + bin;
            [[unroll]] for (uint k = 0; k < kKeys; ++k) {
                const uint key = k < 3 ? bins[row].box.low[k] : bins[row].box.high[k - 3];
                const uint word = at + k * kAllBins;
                if (key > atomicLoad(pool.client.scratch.words[word], gl_ScopeDevice,
                                     gl_StorageSemanticsNone, gl_SemanticsRelaxed))
                    atomicMax(pool.client.scratch.words[word], key);
            }
            atomicAdd(pool.client.scratch.words[at + kKeys * kAllBins], bins[row].count);
        }
    }
}

/// Tells how many primitives of the chunk [begin, end) are in each bin.
void tell_counts(uint begin, uint end, Bin bins[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint bin = bin_of_row(row);
        if (bin < kAllBins) pool.client.scratch.words[chunk_word(begin, end) + bin] = bins[row].count;
    }
}

/// The task's bins.
void fetch_bins(uint first, out Bin bins[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint at = scratch_word(first) + min(bin_of_row(row), kAllBins - 1);
        uint keys[kKeys];
        [[unroll]] for (uint k = 0; k < kKeys; ++k)
            keys[k] = pool.client.scratch.words[at + k * kAllBins];
        bins[row].box = KeyBox(uvec3(keys[0], keys[1], keys[2]), uvec3(keys[3], keys[4], keys[5]));
        bins[row].count = pool.client.scratch.words[at + kKeys * kAllBins];
    }
}
