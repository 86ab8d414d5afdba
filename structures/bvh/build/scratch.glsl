// Memory that the chunks of a large task share. Disjoint ranges of more than kChunkPrimitives begin in
// different multiples of it, so where a range begins names its scratch: nothing is allocated.

const uint kChildWord = kAllBinWords;                // four boxes of keys: see take_children()
const uint kScratchWords = kChildWord + 4 * kKeys;

uint scratch_word(uint first) { return first / kChunkPrimitives * kScratchWords; }

/// Word that belongs to the chunk [begin, end) alone: full chunks have one per multiple of
/// kChunkPrimitives, and so have shorter ones, the last of their tasks.
uint chunk_word(uint begin, uint end) {
    const uint all = (pool.client.mesh.data.triangle_count / kChunkPrimitives + 1) * kScratchWords;
    return all + 2 * (begin / kChunkPrimitives) + (end - begin < kChunkPrimitives ? 1 : 0);
}

void clear_scratch(uint first) {
    for (uint i = gl_SubgroupInvocationID; i < kScratchWords; i += gl_SubgroupSize)
        pool.client.scratch.words[scratch_word(first) + i] = 0;
    pool_spend(kScratchWords / gl_SubgroupSize);
}

/// Joins reduce_rows[0 .. rows) into the task's words from kChildWord on.
void flush_rows(uint first, uint rows) {
    for (uint k = gl_SubgroupInvocationID; k < rows; k += gl_SubgroupSize)
        atomicMax(pool.client.scratch.words[scratch_word(first) + kChildWord + k], reduce_rows[k]);
}

/// Brings the task's words from kChildWord on to reduce_rows.
void fetch_rows(uint first, uint rows) {
    for (uint k = gl_SubgroupInvocationID; k < rows; k += gl_SubgroupSize)
        reduce_rows[k] = pool.client.scratch.words[scratch_word(first) + kChildWord + k];
    subgroup_sync();
}

/// Exclusive scan over the chunk words of a range; returns the sum.
uint scan_chunks(uint first, uint count) {
    uint sum = 0;
    for (uint i = 0; i * kChunkPrimitives < count; i += gl_SubgroupSize) {
        const uint chunk = i + gl_SubgroupInvocationID;
        const bool used = chunk * kChunkPrimitives < count;
        const uint begin = first + chunk * kChunkPrimitives;
        const uint word = chunk_word(begin, min(begin + kChunkPrimitives, first + count));
        const uint mine = used ? pool.client.scratch.words[word] : 0;
        const uint before = subgroupExclusiveAdd(mine);
        if (used) pool.client.scratch.words[word] = sum + before;
        sum += subgroupAdd(mine);
        pool_spend(1);
    }
    return sum;
}
