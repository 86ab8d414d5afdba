// Host side of median.comp.
#include "structures/metric_tree/median_shared.h"

#include <algorithm>

#include "structures/metric_tree/linker.hpp"

std::span<const taskpool::gpu::Shader> structures_metric_tree_shaders();

namespace structures::metric_tree {
namespace {

using namespace taskpool;

// The kernel's struct Task and struct Client.
struct Task {
    uint first, count, side, owner, ancestor, depth;
    uint attempt, pivot, node;
    float delta;
    uint counts[3];
    float bounds[5];
};
struct Client {
    std::uint64_t nodes, header, ids[2], scratch;
    uint cluster_count, seed;
};
static_assert(sizeof(Task) == 72 && sizeof(Client) == 48);

constexpr std::uint32_t kLoops = 40;  // see ClientSpec::loops

std::size_t scratch_words(std::size_t clusters) {
    return (clusters / kChunkElements + 1) * kScratchWords;
}

pool::ClientSpec client_spec(const gpu::Device& device, BuilderKind builder,
                             const Variant& variant) {
    const std::uint32_t lanes = device.subgroup_size(), leaf = std::min(lanes, kMostLeafRange);
    const bool by_cost = builder == BuilderKind::cost;
    pool::ClientSpec spec;
    spec.task_bytes = sizeof(Task);
    spec.loops = kLoops;
    spec.constants = variant.constants();
    spec.constants.insert(spec.constants.end(), {{18, by_cost}, {19, lanes}, {20, leaf}});

    // As choice_iterations() of the kernel.
    const auto choice = [&](std::uint32_t count, std::uint32_t stride) {
        const std::uint32_t candidates = by_cost ? 3 * std::min(kQuantiles, count) : count;
        return (candidates / stride + 2) * ((by_cost ? 2 : 1) * (count + 1) + 1);
    };
    // The longest subtree is one where every range loses but its pivot.
    const std::uint32_t turn = pool::turn_iterations(device, kLoops);
    std::uint32_t subtree = 0;
    for (std::uint32_t count = kSubtreeElements; count > leaf; --count)
        subtree += 4 * (count + 1) + choice(count, lanes) + 4 * (count / lanes + 2) + 2 * turn;
    for (std::uint32_t count = leaf; count-- > 0;)
        subtree += 5 * (leaf + 1) + choice(count, 1) + turn;
    const std::uint32_t large =
        kPivotSample + choice(kDeltaSample, lanes) + 8 * kChunkElements / lanes;
    // Scans in transitions: enough for 8192 chunks by 8 lanes.
    spec.chunk_iterations = std::max(subtree, large) + 2048;
    return spec;
}

class Median final : public Linker {
  public:
    Median(gpu::Device& device, const BuildConfig& config, const Variant& variant)
        : device_(&device),
          pool_(device,
                gpu::find_shader(structures_metric_tree_shaders(),
                                 "structures/metric_tree/median.comp"),
                client_spec(device, config.builder, variant), config.pool) {
        client_.seed = static_cast<uint>(config.seed ^ config.seed >> 32);
    }

    void restart(const LinkInput& input) override {
        if (ids_[0].size() < std::max<std::size_t>(input.cluster_count, 1) * sizeof(uint))
            allocate(input.cluster_count);
        client_.nodes = input.nodes;
        client_.header = input.header;
        client_.cluster_count = input.cluster_count;
        Task root{};
        root.count = input.cluster_count;
        const uint chunks = std::max(root.count / kChunkElements, 1u);
        pool_.restart(pool::RootStart{kPhaseCount, 0, root.count > 0 ? chunks : 0}, root);
    }
    void record(gpu::Recorder& recorder) override { pool_.record(recorder, client_); }
    bool advance() override { return pool_.advance(); }
    double progress() const override {
        return client_.cluster_count > 0 ? double(status().state.progress) / client_.cluster_count
                                         : 1;
    }
    const pool::PoolStatus& status() const override { return pool_.status(); }

  private:
    void allocate(std::size_t clusters) {
        for (int side = 0; side < 2; ++side) {
            ids_[side] = gpu::Buffer(*device_, clusters * sizeof(uint), "metric tree elements");
            client_.ids[side] = ids_[side].address();
        }
        scratch_ = gpu::Buffer(*device_, scratch_words(clusters) * 4, "metric tree scratch");
        client_.scratch = scratch_.address();
    }

    gpu::Device* device_;
    pool::Pool pool_;
    gpu::Buffer ids_[2], scratch_;
    Client client_{};
};

}  // namespace

std::unique_ptr<Linker> make_median(gpu::Device& device, const BuildConfig& config,
                                    const Variant& variant) {
    return std::make_unique<Median>(device, config, variant);
}

std::size_t median_bytes(const gpu::Device& device, const BuildConfig& config,
                         std::size_t clusters) {
    return clusters * 2 * sizeof(uint) + scratch_words(clusters) * 4 +
           pool::Pool::required_bytes(device, client_spec(device, config.builder, {}), config.pool);
}

}  // namespace structures::metric_tree
