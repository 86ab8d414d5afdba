// Push constants of the primitives' kernels, for C++ and GLSL. Addresses are of arrays of words.
#include "taskpool/gpu/shared_types.h"
#ifdef __cplusplus
namespace taskpool::primitives {
using namespace taskpool::gpu::shared_types;
#endif

/// block_sums, block_scan, compact_blocks, and (partials and block_count only) scan_partials.
struct ScanPush {
    uint64_t source;
    uint64_t target;
    uint64_t values;    ///< compaction: what is kept; 0 keeps indices
    uint64_t total;     ///< where the sum of all elements goes; 0: nowhere
    uint64_t partials;  ///< one word per block: its sum, then the sum of the blocks before it
    uint count;
    uint block_count, block_length;
};

/// sort_histogram, sort_scatter.
struct SortPush {
    uint64_t keys, values;
    uint64_t sorted_keys, sorted_values;
    uint64_t histogram;  ///< [digit][block]: counts, then places of the first such key
    uint count;
    uint block_count, block_length;
    uint word, shift, mask;  ///< the digit: `mask` of what this word of a key holds above `shift`
};

#ifdef __cplusplus
static_assert(sizeof(ScanPush) == 56);
static_assert(sizeof(SortPush) == 64);
}  // namespace taskpool::primitives
#endif
