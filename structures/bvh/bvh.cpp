#include "structures/bvh/bvh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "structures/bvh/build/build_shared.h"

std::span<const taskpool::gpu::Shader> structures_bvh_shaders();

namespace structures::bvh {
namespace {

using namespace taskpool;

constexpr std::uint32_t kLoops = 64;  // see ClientSpec::loops
constexpr std::uint32_t kDeterministicLeafRange = 8;
constexpr std::uint32_t kMaxLeafRange = 32;  // a set of lanes is one word there

// The kernel's struct Task: 18 words of range and rule, 6 of bounds, and five boxes of keys.
struct Task {
    uint first, count, node, depth, side;
    uint box[kKeys];
    float center_lower[3], center_upper[3];
    uint rule, axis;
    float middle;
    uint cut, looks, axes;
    float bin_scale[3], bin_offset[3];
    uint left_count;
    uint children[4 * kKeys];
};
static_assert(sizeof(Task) == 54 * 4);

struct Client {
    std::uint64_t primitives[2], order, nodes, scratch, input;
};
static_assert(sizeof(Client) == 48);

std::size_t scratch_words(std::size_t triangles) {
    const std::size_t chunks = triangles / kChunkPrimitives + 1, bins = 3 * kBins;
    return chunks * (bins * (kKeys + 1) + 4 * kKeys) + 2 * (chunks + 1) * bins;
}

std::size_t node_count(std::size_t triangles) { return std::max<std::size_t>(2 * triangles, 1); }

std::uint32_t leaf_range_of(std::uint32_t lanes, const Config& config) {
    return std::min(lanes, config.deterministic ? kDeterministicLeafRange : kMaxLeafRange);
}

pool::ClientSpec client_spec(const gpu::Device& device, const Config& config) {
    const std::uint32_t lanes = device.subgroup_size();
    const std::uint32_t axis_lanes = std::min(lanes, 8u);
    pool::ClientSpec spec;
    spec.loops = kLoops;
    spec.task_bytes = sizeof(Task);
    // A small task's look and its move, or a subtree of one primitive here, the others there; and
    // the transition.
    const std::uint32_t groups = kChunkPrimitives / lanes,
                        leaf_range = leaf_range_of(lanes, config);
    const std::uint32_t small = kChunkPrimitives / axis_lanes + 4 * groups,
                        turns = 2 * kSubtreePrimitives * pool::turn_iterations(device, kLoops),
                        subtree = 40 * kSubtreePrimitives +
                                  2 * (leaf_range + 2) * (leaf_range + 2) + turns;
    spec.chunk_iterations = std::max(small, subtree) + 1024;
    spec.constants = {
        {16, axis_lanes},
        {17, (3 * axis_lanes + lanes - 1) / lanes},
        {18, config.max_leaf_size},
        {19, config.leaf_by_cost},
        {20, float(config.costs.traversal)},
        {21, float(config.costs.intersection)},
        {22, leaf_range},
        {25, lanes},
        {23, config.split == Split::spatial_median},
        {24, config.max_depth},
    };
    return spec;
}

const Config& checked(const gpu::Device& device, const Config& config) {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw std::invalid_argument(fmt::format("BVH build: {}", what));
    };
    const std::uint32_t lanes = device.subgroup_size();
    require(config.max_leaf_size >= 1 && config.max_leaf_size <= std::min(lanes, 8u),
            "max_leaf_size must be from 1 to 8, and at most the subgroup size");
    require(config.max_depth >= 33, "max_depth must be at least 33");
    require(config.costs.traversal >= 0 && config.costs.intersection > 0, "costs must be positive");
    return config;
}

}  // namespace

BvhBuild::BvhBuild(gpu::Device& device, const Config& config)
    : device_(&device),
      config_(checked(device, config)),
      pool_(device, gpu::find_shader(structures_bvh_shaders(), "structures/bvh/build/build.comp"),
            client_spec(device, config), config.pool) {}

std::size_t BvhBuild::output_bytes(std::size_t triangles) {
    return node_count(triangles) * sizeof(BvhNode) + triangles * sizeof(uint);
}

std::size_t BvhBuild::required_bytes(std::size_t triangles) const {
    return output_bytes(triangles) + triangles * 2 * sizeof(Primitive) +
           scratch_words(triangles) * 4 + sizeof(BuildInput) +
           pool::Pool::required_bytes(*device_, client_spec(*device_, config_), config_.pool);
}

void BvhBuild::prepare(const geometry::TriangleMesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    if (count >= std::size_t{1} << 31)
        throw std::invalid_argument(fmt::format("{} triangles: a BVH holds less than 2^31", count));
    triangle_count_ = static_cast<std::uint32_t>(count);
    positions_ = gpu::make_buffer<glm::vec3>(*device_, mesh.positions, "mesh positions");
    triangles_ = gpu::make_buffer<glm::uvec3>(*device_, mesh.triangles, "mesh triangles");
    const BuildInput input{positions_.address(), triangles_.address(), triangle_count_, 0};
    input_ = gpu::make_buffer<BuildInput>(*device_, std::span(&input, 1), "BVH build input");
    for (gpu::Buffer& primitives : primitives_)
        primitives = gpu::Buffer(*device_, count * sizeof(Primitive), "BVH build primitives");
    nodes_ = gpu::Buffer(*device_, node_count(count) * sizeof(BvhNode), "BVH nodes");
    order_ = gpu::Buffer(*device_, count * sizeof(uint), "BVH order");
    scratch_ = gpu::Buffer(*device_, scratch_words(count) * 4, "BVH build scratch");
}

void BvhBuild::release_scratch() {
    for (gpu::Buffer& primitives : primitives_) primitives = {};
    scratch_ = {};
}

void BvhBuild::restart() {
    Task root{};
    root.count = triangle_count_;
    const std::uint32_t chunks = (triangle_count_ + kChunkPrimitives - 1) / kChunkPrimitives;
    pool_.restart(pool::RootStart{kPhaseSetup, 0, chunks}, root);
    first_launch_ = true;
}

void BvhBuild::record(gpu::Recorder& recorder) {
    if (first_launch_) {
        recorder.fill(scratch_, 0);
        recorder.barrier();
        first_launch_ = false;
    }
    pool_.record(recorder, Client{{primitives_[0].address(), primitives_[1].address()},
                                  order_.address(),
                                  nodes_.address(),
                                  scratch_.address(),
                                  input_.address()});
}

bool BvhBuild::advance() { return pool_.advance(); }

double BvhBuild::progress() const {
    return triangle_count_ ? double(status().state.progress) / triangle_count_ : 1;
}

std::uint32_t BvhBuild::node_capacity() const {
    return static_cast<std::uint32_t>(node_count(triangle_count_));
}

Tree BvhBuild::read_back() const {
    return {gpu::read<BvhNode>(nodes_, node_capacity()),
            gpu::read<std::uint32_t>(order_, primitive_count())};
}

std::span<const std::string> phase_names() {
    static const std::string names[] = {"setup",     "compact", "bins",   "count",
                                        "partition", "small",   "subtree"};
    return names;
}

}  // namespace structures::bvh
