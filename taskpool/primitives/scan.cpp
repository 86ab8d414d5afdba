#include "taskpool/primitives/scan.hpp"

#include <algorithm>
#include <stdexcept>

#include "taskpool/primitives/blocks.hpp"

std::span<const taskpool::gpu::Shader> taskpool_shaders();

namespace taskpool::primitives {
namespace {

constexpr std::uint32_t kLaneWords = 4;  // as in quad.glsl

gpu::Kernel kernel(gpu::Device& device, std::string_view path,
                   const std::vector<gpu::Constant>& constants = {}) {
    return gpu::Kernel(device, gpu::find_shader(taskpool_shaders(), path), constants);
}

Blocks scan_blocks(std::uint32_t count, std::uint32_t lanes) {
    constexpr std::uint32_t kMinIterations = 16;
    return cut(count, lanes * kLaneWords, kMinIterations);
}

std::size_t partials_bytes(std::uint32_t count, std::uint32_t lanes) {
    return std::size_t{scan_blocks(count, lanes).count} * 4;
}

void check_count(std::uint32_t count) {
    if (count > kMaxCount)
        throw std::invalid_argument("scan of more than 2^31 elements: cut the array");
}

/// Steps 1 to 3; the last one is `finish`.
void record_steps(gpu::Recorder& recorder, ScanPush push, std::uint32_t lanes,
                  const gpu::Kernel& block_sums, const gpu::Kernel& scan_partials,
                  const gpu::Kernel& finish) {
    const Blocks blocks = scan_blocks(push.count, lanes);
    push.block_count = blocks.count;
    push.block_length = blocks.length;
    if (blocks.count > 1) {
        recorder.dispatch(block_sums, push, blocks.count);
        recorder.barrier();
        recorder.dispatch(scan_partials, push, 1);
        recorder.barrier();
    }
    // An empty array still has a sum.
    recorder.dispatch(finish, push, std::max(blocks.count, 1u));
    recorder.barrier();
}

}  // namespace

Scan::Scan(gpu::Device& device)
    : lanes_(device.subgroup_size()),
      block_sums_(kernel(device, "taskpool/primitives/block_sums.comp")),
      scan_partials_(kernel(device, "taskpool/primitives/scan_partials.comp")),
      block_scan_(kernel(device, "taskpool/primitives/block_scan.comp")) {}

std::size_t Scan::scratch_bytes(std::uint32_t count) const { return partials_bytes(count, lanes_); }

void Scan::record(gpu::Recorder& recorder, Range source, Range target, std::uint32_t count,
                  Range scratch, Range total) const {
    check_count(count);
    require(source, std::size_t{count} * 4, "scan: source");
    require(target, std::size_t{count} * 4, "scan: target");
    require(scratch, scratch_bytes(count), "scan: scratch");
    if (total.address) require(total, 4, "scan: total");
    ScanPush push{};
    push.source = source.address;
    push.target = target.address;
    push.total = total.address;
    push.partials = scratch.address;
    push.count = count;
    record_steps(recorder, push, lanes_, block_sums_, scan_partials_, block_scan_);
}

Compact::Compact(gpu::Device& device)
    : lanes_(device.subgroup_size()),
      block_sums_(kernel(device, "taskpool/primitives/block_sums.comp", {{1, true}})),
      scan_partials_(kernel(device, "taskpool/primitives/scan_partials.comp")),
      compact_blocks_(kernel(device, "taskpool/primitives/compact_blocks.comp")) {}

std::size_t Compact::scratch_bytes(std::uint32_t count) const {
    return partials_bytes(count, lanes_);
}

void Compact::record(gpu::Recorder& recorder, Range flags, Range values, Range target, Range kept,
                     std::uint32_t count, Range scratch) const {
    check_count(count);
    const std::size_t bytes = std::size_t{count} * 4;
    require(flags, bytes, "compaction: flags");
    if (values.address) require(values, bytes, "compaction: values");
    require(target, bytes, "compaction: target");
    require(kept, 4, "compaction: kept");
    require(scratch, scratch_bytes(count), "compaction: scratch");
    ScanPush push{};
    push.source = flags.address;
    push.target = target.address;
    push.values = values.address;
    push.total = kept.address;
    push.partials = scratch.address;
    push.count = count;
    record_steps(recorder, push, lanes_, block_sums_, scan_partials_, compact_blocks_);
}

}  // namespace taskpool::primitives
