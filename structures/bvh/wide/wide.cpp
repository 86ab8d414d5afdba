#include "structures/bvh/wide/wide.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

std::span<const taskpool::gpu::Shader> structures_bvh_wide_shaders();

namespace structures::bvh::wide {
namespace {

using geometry::CornerTriangle;
using taskpool::gpu::Buffer;
using taskpool::gpu::Kernel;
using taskpool::gpu::Recorder;

struct BuildPush {
    std::uint64_t binary, nodes, header, items, levels, chunks;
    std::uint32_t level;
};

Kernel kernel(taskpool::gpu::Device& device, const char* name) {
    return Kernel(device, taskpool::gpu::find_shader(structures_bvh_wide_shaders(),
                                                     std::string("structures/bvh/wide/") + name));
}

std::uint64_t chunk_count(const Capacity& capacity) {
    return max_wide_nodes(capacity) / kChunk + 1;
}

}  // namespace

std::uint64_t max_wide_nodes(const Capacity& capacity) {
    // A leaf of c > 7 triangles is halved into parts of 4 or more: fewer than c / 4 + 1 of them.
    const std::uint64_t leaves = std::min<std::uint64_t>(
        capacity.triangles, (std::uint64_t(capacity.nodes) + 1) / 2 + capacity.triangles / 4);
    return (4 * leaves + 6) / 7 + 1;
}

std::size_t WideBuilder::tree_bytes(const Capacity& capacity) {
    return max_wide_nodes(capacity) * kWidth * sizeof(WideChild) +
           std::size_t(capacity.triangles) * sizeof(CornerTriangle) + sizeof(WideHeader);
}

std::size_t WideBuilder::scratch_bytes(const Capacity& capacity) {
    return max_wide_nodes(capacity) * sizeof(WideItem) + chunk_count(capacity) * 4 +
           (kLevels + 1) * sizeof(WideLevel);
}

WideBuilder::WideBuilder(taskpool::gpu::Device& device)
    : device_(device),
      begin_(kernel(device, "begin.comp")),
      open_(kernel(device, "open.comp")),
      number_(kernel(device, "number.comp")),
      link_(kernel(device, "link.comp")),
      gather_(device) {}

void WideBuilder::prepare(const Capacity& capacity) {
    const std::uint64_t nodes = max_wide_nodes(capacity);
    if (nodes > kMaxNodes || capacity.triangles > kLeafFirstMask)
        throw std::invalid_argument(
            fmt::format("wide BVH over {} triangles: may need {} nodes, at most {} are supported; "
                        "split the mesh",
                        capacity.triangles, nodes, kMaxNodes));
    header_ = Buffer(device_, sizeof(WideHeader), "wide BVH header");
    nodes_ = Buffer(device_, nodes * kWidth * sizeof(WideChild), "wide BVH nodes");
    triangles_ = Buffer(device_, std::size_t(capacity.triangles) * sizeof(CornerTriangle),
                        "wide BVH triangles");
    items_ = Buffer(device_, nodes * sizeof(WideItem), "wide BVH items");
    levels_ = Buffer(device_, (kLevels + 1) * sizeof(WideLevel), "wide BVH levels");
    chunks_ = Buffer(device_, chunk_count(capacity) * 4, "wide BVH chunks");
}

void WideBuilder::record(Recorder& recorder, const BinaryTree& binary) {
    order_count_ = binary.order_count;
    const BuildPush push{binary.nodes,
                         nodes_.address(),
                         header_.address(),
                         items_.address(),
                         levels_.address(),
                         chunks_.address(),
                         0};
    recorder.dispatch(begin_, push, 1);
    recorder.barrier();
    gather_.record(recorder, {binary.order, binary.positions, binary.corners, triangles_.address(),
                              binary.order_count, binary.primitive_count});
    recorder.barrier();
    record_levels(recorder, binary);
}

void WideBuilder::record_rest(Recorder& recorder, const BinaryTree& binary) {
    recorder.copy(levels_, levels_, sizeof(WideLevel), kLevels * sizeof(WideLevel), 0);
    recorder.barrier();
    record_levels(recorder, binary);
}

void WideBuilder::record_levels(Recorder& recorder, const BinaryTree& binary) {
    BuildPush push{binary.nodes,
                   nodes_.address(),
                   header_.address(),
                   items_.address(),
                   levels_.address(),
                   chunks_.address(),
                   0};
    for (push.level = 0; push.level < kLevels; ++push.level) {
        const std::size_t groups = push.level * sizeof(WideLevel);
        recorder.dispatch_indirect(open_, push, levels_, groups);
        recorder.barrier();
        recorder.dispatch(number_, push, 1);
        recorder.barrier();
        recorder.dispatch_indirect(link_, push, levels_, groups);
        recorder.barrier();
    }
}

WideHeader WideBuilder::header() const {
    return taskpool::gpu::read<WideHeader>(header_, 1).front();
}

std::uint32_t WideBuilder::pending() const { return header().pending; }

WideTree WideBuilder::tree() const {
    return {header_.address(), nodes_.address(), triangles_.address()};
}

std::vector<WideChild> WideBuilder::read_nodes() const {
    return taskpool::gpu::read<WideChild>(nodes_, std::size_t(header().node_count) * kWidth);
}

std::vector<CornerTriangle> WideBuilder::read_triangles() const {
    return taskpool::gpu::read<CornerTriangle>(triangles_, order_count_);
}

}  // namespace structures::bvh::wide
