// Four consecutive words per lane: fewer subgroup operations per element than one.
const uint kLaneWords = 4;

/// Words first..first+3 of `source`; 0 from `end` on.
uvec4 load_quad(UintArray source, uint first, uint end) {
    uvec4 words = uvec4(0);
    [[unroll]] for (uint k = 0; k < kLaneWords; ++k) {
        if (first + k < end) words[k] = source.at[first + k];
    }
    return words;
}

/// 1 for each word that is not 0.
uvec4 as_flags(uvec4 words) { return min(words, uvec4(1)); }

uint sum(uvec4 words) { return words.x + words.y + words.z + words.w; }

/// The end of block `block`, as elements.
uint block_end(uint block, uint length, uint count) {
    // Not block * length + length, which may wrap around.
    return count - block * length > length ? (block + 1) * length : count;
}
