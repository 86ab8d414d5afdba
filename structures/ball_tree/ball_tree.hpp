// Binary ball tree over the centroids of triangles, built on the GPU by the task pool.
//
//     BallTreeBuild build(device, {.leaf_size = 8});
//     build.prepare(mesh);                        // allocates and uploads
//     taskpool::pool::run(device, build);
//     NearestQuery query(device);
//     query.record(recorder, build, positions, results, count);
//
// Degenerate triangles are left out. Builds are deterministic: equal meshes give equal trees,
// whatever the device, the scheduling policy and the number of workgroups.
#pragma once

#include <cstdint>
#include <vector>

#include "structures/ball_tree/ball_tree_shared.h"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/pool/job.hpp"
#include "taskpool/pool/pool.hpp"

namespace structures::ball_tree {

struct Config {
    std::uint32_t leaf_size =
        8;  ///< points per leaf at most, 1 to 64; copies of one are not counted
    taskpool::pool::PoolConfig pool;
};

/// A ball tree on the host; `nodes` is never empty, see ball_tree_shared.h for the empty tree.
struct Tree {
    std::vector<BallNode> nodes;
    std::vector<BallPoint> points;
};

class BallTreeBuild final : public taskpool::pool::Job {
  public:
    /// Throws std::invalid_argument if leaf_size is out of range.
    BallTreeBuild(taskpool::gpu::Device& device, const Config& config);

    /// Bytes of a build beside the uploaded mesh: pool (before any growth), scratch and output.
    std::size_t required_bytes(std::size_t triangle_count) const;
    /// Throws std::invalid_argument for a mesh of 2^31 or more triangles.
    void prepare(const geometry::TriangleMesh& mesh);

    void restart() override;
    void record(taskpool::gpu::Recorder& recorder) override;
    bool advance() override { return pool_.advance(); }
    double progress() const override;

    /// Output, valid when the job is done: BallNode[] and BallPoint[], see ball_tree_shared.h.
    const taskpool::gpu::Buffer& nodes() const { return nodes_; }
    const taskpool::gpu::Buffer& points() const { return points_[0]; }
    const Config& config() const { return config_; }
    const taskpool::pool::PoolStatus& status() const { return pool_.status(); }
    Tree read_back() const;

  private:
    taskpool::gpu::Device* device_;
    Config config_;
    taskpool::pool::Pool pool_;
    taskpool::gpu::Buffer positions_, triangles_, points_[2], nodes_, gathers_;
    std::uint32_t triangle_count_ = 0;
};

/// Answers nearest-point queries on the device; see query.glsl for use inside other kernels.
class NearestQuery {
  public:
    explicit NearestQuery(taskpool::gpu::Device& device);
    /// Records `count` queries: vec3[] `positions` in, Nearest[] `results` out. No barriers.
    void record(taskpool::gpu::Recorder& recorder, const BallTreeBuild& tree,
                const taskpool::gpu::Buffer& positions, const taskpool::gpu::Buffer& results,
                std::uint32_t count) const;

  private:
    taskpool::gpu::Kernel kernel_;
};

}  // namespace structures::ball_tree
