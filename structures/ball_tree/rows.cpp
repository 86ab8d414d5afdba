// What this folder adds to the registry of structures.
#include <algorithm>

#include "structures/ball_tree/reference.hpp"
#include "structures/hash.hpp"
#include "structures/structure.hpp"

namespace structures::ball_tree {
namespace {

std::span<const Parameter> parameters() {
    static const Parameter all[] = {
        {"leaf_size", std::int64_t{8}, "points per leaf at most", {}, 1, 64},
        {"policy", std::string("bitmap"), "scheduling of the task pool", {"scan", "bitmap"}},
        {"workgroups", std::int64_t{0}, "per launch (0: as the device likes)", {}, 0, 65535},
        {"slots", std::int64_t{4096}, "of the task pool to begin with", {}, 1, 1 << 24},
    };
    return all;
}

Config config_of(const Settings& settings) {
    Config config;
    config.leaf_size = static_cast<std::uint32_t>(settings.integer("leaf_size"));
    config.pool.policy = taskpool::pool::policy_from(settings.text("policy"));
    config.pool.subgroups = static_cast<std::uint32_t>(settings.integer("workgroups"));
    config.pool.slots = static_cast<std::uint32_t>(settings.integer("slots"));
    return config;
}

class BallTreeBuilder final : public Builder {
  public:
    BallTreeBuilder(taskpool::gpu::Device& device, const Config& config) : build_(device, config) {}

    std::size_t required_bytes(std::size_t triangle_count) const override {
        return build_.required_bytes(triangle_count);
    }
    void prepare(const geometry::TriangleMesh& mesh) override {
        mesh_ = &mesh;
        build_.prepare(mesh);
    }
    taskpool::pool::Job& job() override { return build_; }

    Samples metrics() override {
        const Tree tree = build_.read_back();
        double nodes = 0, leaves = 0, depth_max = 0, depth_sum = 0;
        walk(tree, [&](const BallNode& node, std::uint32_t depth) {
            nodes += 1;
            if (node.count == 0) return;
            leaves += 1;
            depth_max = std::max(depth_max, double(depth));
            depth_sum += depth;
        });
        const taskpool::pool::PoolStatus& status = build_.status();
        return {{"nodes", nodes},
                {"depth_max", depth_max},
                {"depth_mean", leaves > 0 ? depth_sum / leaves : 0},
                {"leaf_size_mean", leaves > 0 ? double(tree.points.size()) / leaves : 0},
                {"degenerate", double(mesh_->triangle_count() - tree.points.size())},
                {"tasks", double(status.state.spawned) + 1},
                {"pool_peak", double(status.state.peak_live)}};
    }
    std::vector<std::string> validate() override {
        return ball_tree::validate(*mesh_, build_.read_back(), build_.config().leaf_size);
    }
    std::uint64_t fingerprint() override {
        Hash hash;
        const Tree tree = build_.read_back();
        // By a walk, since the array has holes.
        walk(tree, [&](const BallNode& node, std::uint32_t) { hash.add(node); });
        for (const BallPoint& point : tree.points) hash.add(point);
        return hash.value();
    }

  private:
    BallTreeBuild build_;
    const geometry::TriangleMesh* mesh_ = nullptr;
};

std::unique_ptr<Builder> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<BallTreeBuilder>(device, config_of(settings));
}

}  // namespace

std::span<const StructureRow> rows() {
    static const StructureRow all[] = {
        {"ball_tree", "binary ball tree over triangle centroids, with nearest-point queries",
         &parameters, &create}};
    return all;
}

}  // namespace structures::ball_tree
