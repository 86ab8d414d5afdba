// Memory that the chunks of a large task share. Disjoint ranges of more than kChunkPrimitives begin in
// different multiples of it, so where a range begins names its scratch: nothing is allocated.

const uint kChildWord = kPlanes * kPlaneWords;  // four boxes of keys: see move_range()
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
    pool_order_lanes();
    return sum;
}

/// Joins this subgroup's planes into the task's.
void flush_planes(uint first, Plane planes[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint id = row * gl_SubgroupSize + gl_SubgroupInvocationID;
        if (id >= kPlanes) break;
        const uint at = scratch_word(first) + id * kPlaneWords;
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            atomicMax(pool.client.scratch.words[at + k], planes[row].left.low[k]);
            atomicMax(pool.client.scratch.words[at + 3 + k], planes[row].left.high[k]);
            atomicMax(pool.client.scratch.words[at + 6 + k], planes[row].right.low[k]);
            atomicMax(pool.client.scratch.words[at + 9 + k], planes[row].right.high[k]);
        }
        atomicAdd(pool.client.scratch.words[at + 12], planes[row].left_count);
    }
}

/// Fills the planes' boxes and counts with the task's.
void fetch_planes(uint first, inout Plane planes[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint id = min(row * gl_SubgroupSize + gl_SubgroupInvocationID, kPlanes - 1);
        const uint at = scratch_word(first) + id * kPlaneWords;
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            planes[row].left.low[k] = pool.client.scratch.words[at + k];
            planes[row].left.high[k] = pool.client.scratch.words[at + 3 + k];
            planes[row].right.low[k] = pool.client.scratch.words[at + 6 + k];
            planes[row].right.high[k] = pool.client.scratch.words[at + 9 + k];
        }
        planes[row].left_count = pool.client.scratch.words[at + 12];
    }
}
