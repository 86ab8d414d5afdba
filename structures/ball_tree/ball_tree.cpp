// Host side of the build: buffers, constants, launches.
#include "structures/ball_tree/ball_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

std::span<const taskpool::gpu::Shader> structures_ball_tree_shaders();

namespace structures::ball_tree {
namespace {

using namespace taskpool;

// The kernel's struct Task and struct Client.
struct Task {
    uint first, count, node, depth, side, left_count;
    float bounds[18];
};
struct Client {
    std::uint64_t positions, triangles, points[2], nodes, gathers;
};
static_assert(sizeof(Task) == 96 && sizeof(Client) == 48);

pool::ClientSpec client_spec(const gpu::Device& device, const Config& config) {
    if (config.leaf_size < 1 || config.leaf_size > 64)
        throw std::invalid_argument(
            fmt::format("ball tree: leaf_size is {}; give 1 to 64", config.leaf_size));
    // A chunk has less than 2 * kChunkPoints points. The scan of a transition over a thousand times
    // as many takes as long again.
    const std::uint32_t chunk = 2 * kChunkPoints / device.subgroup_size();
    return {sizeof(Task), 2 * chunk + 128, {{16, config.leaf_size}}};
}

std::size_t node_capacity(std::size_t points) { return std::max<std::size_t>(2 * points, 1); }
std::size_t gather_count(std::size_t points, const Config& config) {
    return points / config.leaf_size + 1;
}

}  // namespace

BallTreeBuild::BallTreeBuild(gpu::Device& device, const Config& config)
    : device_(&device),
      config_(config),
      pool_(device,
            gpu::find_shader(structures_ball_tree_shaders(), "structures/ball_tree/build.comp"),
            client_spec(device, config), config.pool) {}

std::size_t BallTreeBuild::required_bytes(std::size_t triangles) const {
    const std::size_t output =
        node_capacity(triangles) * sizeof(BallNode) + triangles * sizeof(BallPoint);
    const std::size_t scratch =
        triangles * sizeof(BallPoint) + gather_count(triangles, config_) * sizeof(Gather);
    return output + scratch +
           pool::Pool::required_bytes(*device_, client_spec(*device_, config_), config_.pool);
}

void BallTreeBuild::prepare(const geometry::TriangleMesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    if (count >= std::size_t{1} << 31)
        throw std::invalid_argument(
            fmt::format("{} triangles: a ball tree holds less than 2^31", count));
    triangle_count_ = static_cast<std::uint32_t>(count);
    positions_ = gpu::make_buffer<glm::vec3>(*device_, mesh.positions, "mesh positions");
    triangles_ = gpu::make_buffer<glm::uvec3>(*device_, mesh.triangles, "mesh triangles");
    for (gpu::Buffer& side : points_)
        side = gpu::Buffer(*device_, count * sizeof(BallPoint), "ball tree points");
    nodes_ = gpu::Buffer(*device_, node_capacity(count) * sizeof(BallNode), "ball tree nodes");
    gathers_ =
        gpu::Buffer(*device_, gather_count(count, config_) * sizeof(Gather), "ball tree scratch");
}

void BallTreeBuild::restart() {
    // Other tasks' scratch is cleared by who spawns them.
    const Gather cleared{};
    gathers_.write(&cleared, sizeof(cleared));
    Task root{};
    root.count = triangle_count_;
    root.node = kNoNode;
    const std::uint32_t chunks =
        triangle_count_ == 0 ? 0 : std::max(triangle_count_ / kChunkPoints, 1u);
    pool_.restart(pool::RootStart{kPhaseSetup, 0, chunks}, root);
}

void BallTreeBuild::record(gpu::Recorder& recorder) {
    pool_.record(recorder, Client{positions_.address(),
                                  triangles_.address(),
                                  {points_[0].address(), points_[1].address()},
                                  nodes_.address(),
                                  gathers_.address()});
}

double BallTreeBuild::progress() const {
    return triangle_count_ ? double(status().state.progress) / triangle_count_ : 1;
}

Tree BallTreeBuild::read_back() const {
    // Each point was counted when its leaf was written.
    const std::uint32_t points = status().state.progress;
    return {gpu::read<BallNode>(nodes_, node_capacity(points)),
            gpu::read<BallPoint>(points_[0], points)};
}

NearestQuery::NearestQuery(gpu::Device& device)
    : kernel_(device, gpu::find_shader(structures_ball_tree_shaders(),
                                       "structures/ball_tree/nearest.comp")) {}

void NearestQuery::record(gpu::Recorder& recorder, const BallTreeBuild& tree,
                          const gpu::Buffer& positions, const gpu::Buffer& results,
                          std::uint32_t count) const {
    struct {
        std::uint64_t nodes, points, positions, results;
        std::uint32_t count, leaf_size;
    } push{tree.nodes().address(),
           tree.points().address(),
           positions.address(),
           results.address(),
           count,
           tree.config().leaf_size};
    const std::uint32_t lanes = recorder.device().subgroup_size();
    if (count > 0) recorder.dispatch(kernel_, push, (count + lanes - 1) / lanes);
}

}  // namespace structures::ball_tree
