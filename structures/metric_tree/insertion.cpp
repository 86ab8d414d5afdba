// Host side of insertion.comp.
#include <algorithm>
#include <bit>

#include "structures/metric_tree/linker.hpp"

std::span<const taskpool::gpu::Shader> structures_metric_tree_shaders();

namespace structures::metric_tree {
namespace {

using namespace taskpool;

// The kernel's struct Task and struct Client.
struct Task {
    std::uint32_t places;
};
struct Client {
    std::uint64_t nodes, header;
    std::uint32_t cluster_count, chunk_places, seed;
    float delta;
};
static_assert(sizeof(Client) == 32);

/// Elements that a lane inserts in a chunk: many, since chunks cost something, unless then some
/// subgroups had nothing to do.
constexpr std::uint32_t kLanePlaces = 32;
constexpr std::uint32_t kChunksPerSubgroup = 4;

pool::ClientSpec client_spec(const Variant& variant) {
    return {.task_bytes = sizeof(Task),
            .chunk_iterations = kLanePlaces * (kMaxDepth + 1) + 16,
            .constants = variant.constants(),
            .loops = 2};
}

class Insertion final : public Linker {
  public:
    Insertion(gpu::Device& device, const BuildConfig& config, const Variant& variant)
        : lanes_(device.subgroup_size()),
          pool_(device,
                gpu::find_shader(structures_metric_tree_shaders(),
                                 "structures/metric_tree/insertion.comp"),
                client_spec(variant), config.pool) {
        client_.seed = static_cast<std::uint32_t>(config.seed ^ config.seed >> 32);
    }

    void restart(const LinkInput& input) override {
        client_.nodes = input.nodes;
        client_.header = input.header;
        client_.cluster_count = input.cluster_count;
        client_.delta = input.delta;
        places_ = input.cluster_count == 0 ? 0 : std::bit_ceil(input.cluster_count);
        client_.chunk_places =
            lanes_ * std::clamp(places_ / (lanes_ * pool_.subgroups() * kChunksPerSubgroup), 1u,
                                kLanePlaces);
        const std::uint32_t chunks = (places_ + client_.chunk_places - 1) / client_.chunk_places;
        pool_.restart(pool::RootStart{0, 0, chunks}, Task{places_});
    }
    void record(gpu::Recorder& recorder) override { pool_.record(recorder, client_); }
    bool advance() override { return pool_.advance(); }
    double progress() const override {
        return places_ > 0 ? double(status().state.progress) / places_ : 1;
    }
    const pool::PoolStatus& status() const override { return pool_.status(); }

  private:
    std::uint32_t lanes_;
    pool::Pool pool_;
    Client client_{};
    std::uint32_t places_ = 0;
};

}  // namespace

std::unique_ptr<Linker> make_insertion(gpu::Device& device, const BuildConfig& config,
                                       const Variant& variant) {
    return std::make_unique<Insertion>(device, config, variant);
}

std::size_t insertion_bytes(const gpu::Device& device, const BuildConfig& config) {
    return pool::Pool::required_bytes(device, client_spec({}), config.pool);
}

}  // namespace structures::metric_tree
