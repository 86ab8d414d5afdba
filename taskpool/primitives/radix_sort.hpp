// Stable least-significant-digit radix sort of keys with 32-bit payloads.
//
//     RadixSort sort(device, RadixSort::Key::u32);
//     Buffer scratch(device, sort.scratch_bytes(count), "scratch");
//     sort.record(recorder, {codes, ids, sorted_codes, sorted_ids, scratch, count, 30});
//
// Eight bits a pass; a pass is a histogram per block, a scan of all histograms and a scatter (N.
// Satish, M. Harris and M. Garland, "Designing Efficient Sorting Algorithms for Manycore GPUs",
// IPDPS 2009), five dispatches at most.
#pragma once

#include "taskpool/primitives/scan.hpp"

namespace taskpool::primitives {

class RadixSort {
  public:
    /// u64: two words per key, the low one first.
    enum class Key : std::uint32_t { u32 = 1, u64 = 2 };

    struct Job {
        Range keys, values;                ///< kept as they are
        Range sorted_keys, sorted_values;  ///< distinct from the former
        Range scratch;
        std::uint32_t count = 0;
        std::uint32_t key_bits = 32;  ///< low bits that decide; the fewer, the fewer passes
    };

    RadixSort(gpu::Device& device, Key key);

    std::size_t scratch_bytes(std::uint32_t count) const;
    /// What is recorded starts after the caller's barrier and ends with one. Throws
    /// std::invalid_argument if a range is too short, `key_bits` is 0 or more than a key has, or
    /// `count` exceeds kMaxCount / 2.
    void record(gpu::Recorder& recorder, const Job& job) const;

  private:
    std::uint32_t lanes_ = 0, key_words_ = 1;
    Scan scan_;
    gpu::Kernel histogram_, scatter_;
};

}  // namespace taskpool::primitives
