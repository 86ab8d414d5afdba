#include "taskpool/primitives/radix_sort.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "taskpool/primitives/blocks.hpp"

std::span<const taskpool::gpu::Shader> taskpool_shaders();

namespace taskpool::primitives {
namespace {

constexpr std::uint32_t kDigits = 256, kDigitBits = 8;  // as in sort_scatter.comp

Blocks sort_blocks(std::uint32_t count, std::uint32_t lanes) {
    // A block has 256 counters to clear, write, scan and read: it must hold many more keys.
    constexpr std::uint32_t kMinKeys = 4096;
    return cut(count, lanes, (kMinKeys + lanes - 1) / lanes);
}

gpu::Kernel kernel(gpu::Device& device, std::string_view path, std::uint32_t key_words) {
    return gpu::Kernel(device, gpu::find_shader(taskpool_shaders(), path), {{1, key_words}});
}

}  // namespace

RadixSort::RadixSort(gpu::Device& device, Key key)
    : lanes_(device.subgroup_size()),
      key_words_(std::uint32_t(key)),
      scan_(device),
      histogram_(kernel(device, "taskpool/primitives/sort_histogram.comp", key_words_)),
      scatter_(kernel(device, "taskpool/primitives/sort_scatter.comp", key_words_)) {}

// Scratch holds, one behind the other: keys, values, histogram, scratch of the scan.
std::size_t RadixSort::scratch_bytes(std::uint32_t count) const {
    const std::uint32_t counters = kDigits * sort_blocks(count, lanes_).count;
    return (std::size_t{count} * (key_words_ + 1) + counters) * 4 + scan_.scratch_bytes(counters);
}

void RadixSort::record(gpu::Recorder& recorder, const Job& job) const {
    if (job.count > kMaxCount / 2)
        throw std::invalid_argument("sort of more than 2^30 elements: cut the array");
    if (job.key_bits == 0 || job.key_bits > 32 * key_words_)
        throw std::invalid_argument("sort: key_bits must be 1 to " +
                                    std::to_string(32 * key_words_));
    const std::size_t value_bytes = std::size_t{job.count} * 4;
    const std::size_t key_bytes = value_bytes * key_words_;
    require(job.keys, key_bytes, "sort: keys");
    require(job.values, value_bytes, "sort: values");
    require(job.sorted_keys, key_bytes, "sort: sorted_keys");
    require(job.sorted_values, value_bytes, "sort: sorted_values");
    require(job.scratch, scratch_bytes(job.count), "sort: scratch");
    if (job.count == 0) return;

    const Blocks blocks = sort_blocks(job.count, lanes_);
    const std::uint32_t counters = kDigits * blocks.count;
    const Range other_keys = job.scratch, other_values = other_keys.from(key_bytes);
    const Range histogram = other_values.from(value_bytes);
    const Range scan_scratch = histogram.from(std::size_t{counters} * 4);

    SortPush push{};
    push.keys = job.keys.address;
    push.values = job.values.address;
    push.histogram = histogram.address;
    push.count = job.count;
    push.block_count = blocks.count;
    push.block_length = blocks.length;
    const std::uint32_t passes = (job.key_bits + kDigitBits - 1) / kDigitBits;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const bool to_result = (passes - pass) % 2 == 1;  // the last one, and every other before
        push.sorted_keys = (to_result ? job.sorted_keys : other_keys).address;
        push.sorted_values = (to_result ? job.sorted_values : other_values).address;
        const std::uint32_t first_bit = pass * kDigitBits;
        push.word = first_bit / 32;
        push.shift = first_bit % 32;
        push.mask = (1u << std::min(kDigitBits, job.key_bits - first_bit)) - 1;
        recorder.dispatch(histogram_, push, blocks.count);
        recorder.barrier();
        scan_.record(recorder, histogram, histogram, counters, scan_scratch);
        recorder.dispatch(scatter_, push, blocks.count);
        recorder.barrier();
        push.keys = push.sorted_keys;
        push.values = push.sorted_values;
    }
}

}  // namespace taskpool::primitives
