// Exclusive prefix sums, and compaction, which is built on them.
//
//     Scan scan(device);
//     Buffer scratch(device, scan.scratch_bytes(count), "scratch");
//     scan.record(recorder, counts, offsets, count, scratch);   // offsets[i] = sum of counts[0..i)
//
// Reduce, then scan (D. Merrill and A. Grimshaw, "Parallel Scan for Stream Architectures", 2009):
// sums of blocks, a scan of those sums by one subgroup, a scan of each block. Three dispatches, one
// for short arrays; no workgroup waits for another, so no forward progress is assumed. Sums are
// modulo 2^32.
//
// What is recorded starts after the caller's barrier and ends with one. Every method throws
// std::invalid_argument if a range is too short or `count` exceeds kMaxCount.
#pragma once

#include "taskpool/gpu/recorder.hpp"
#include "taskpool/primitives/primitives_shared.h"
#include "taskpool/primitives/range.hpp"

namespace taskpool::primitives {

/// Elements in one array.
inline constexpr std::uint32_t kMaxCount = 1u << 31;

class Scan {
  public:
    explicit Scan(gpu::Device& device);

    std::size_t scratch_bytes(std::uint32_t count) const;
    /// `target` may be `source`. `total` (one word) receives the sum of all elements, if given.
    void record(gpu::Recorder& recorder, Range source, Range target, std::uint32_t count,
                Range scratch, Range total = {}) const;

  private:
    std::uint32_t lanes_ = 0;
    gpu::Kernel block_sums_, scan_partials_, block_scan_;
};

class Compact {
  public:
    explicit Compact(gpu::Device& device);

    std::size_t scratch_bytes(std::uint32_t count) const;
    /// target[k] = values[i] for the k-th i whose flags[i] is not 0; `kept` (one word) receives how
    /// many there are. Without `values` the indices i themselves are written. `target` must have
    /// room for all `count`, and must be neither `flags` nor `values`.
    void record(gpu::Recorder& recorder, Range flags, Range values, Range target, Range kept,
                std::uint32_t count, Range scratch) const;

  private:
    std::uint32_t lanes_ = 0;
    gpu::Kernel block_sums_, scan_partials_, compact_blocks_;
};

}  // namespace taskpool::primitives
