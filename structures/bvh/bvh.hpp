// BVH built on the GPU by the task pool.
//
//     BvhBuild build(device, {.split = Split::binned_sah});
//     build.prepare(mesh);                       // allocates and uploads
//     taskpool::pool::run(device, build);        // or record() and advance() by hand
//     build.nodes().address();                   // BvhNode[], see bvh_shared.h
//     Tree tree = build.read_back();
//
// Vinkler, Bittner and Havran, "Massively Parallel Hierarchical Scene Processing with Applications
// in Rendering", 2013, section 4.1; what differs is said in build/build.comp. Builds are
// deterministic.
#pragma once

#include "structures/bvh/tree.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/pool/job.hpp"
#include "taskpool/pool/pool.hpp"

namespace structures::bvh {

enum class Split {
    binned_sah,      ///< the cheapest split between bins on the three axes
    spatial_median,  ///< the middle of the centres' bounds, on their longest axis
};

struct Config {
    Split split = Split::binned_sah;
    std::uint32_t max_leaf_size = 4;  ///< 1 to 8
    bool leaf_by_cost = true;         ///< false: every range of at most max_leaf_size is a leaf
    CostModel costs;
    std::uint32_t max_depth = 64;
    /// Full SAH for ranges of at most 8 primitives, as on the smallest subgroups, so that the tree
    /// is the same on every device; otherwise for ranges that fit the device's subgroup.
    bool deterministic = false;
    taskpool::pool::PoolConfig pool;
};

class BvhBuild final : public taskpool::pool::Job {
  public:
    /// Throws std::invalid_argument if a value of `config` is out of range.
    BvhBuild(taskpool::gpu::Device& device, const Config& config);

    /// Bytes of a build of `triangle_count` triangles: all of it, and what remains as output.
    std::size_t required_bytes(std::size_t triangle_count) const;
    static std::size_t output_bytes(std::size_t triangle_count);

    /// Uploads the mesh and allocates. Throws std::invalid_argument for a mesh of 2^31 or more
    /// triangles.
    void prepare(const geometry::TriangleMesh& mesh);

    void restart() override;
    void record(taskpool::gpu::Recorder& recorder) override;
    bool advance() override;
    double progress() const override;

    /// Output, valid when the job is done: nodes (with holes), and primitive ids in leaf order.
    const taskpool::gpu::Buffer& nodes() const { return nodes_; }
    const taskpool::gpu::Buffer& order() const { return order_; }
    /// Upper bound of node indices, and the number of triangles, degenerate ones included.
    std::uint32_t node_capacity() const;
    std::uint32_t triangle_count() const { return triangle_count_; }
    /// Triangles that are in the tree: all but the degenerate ones. Valid when the job is done.
    std::uint32_t primitive_count() const { return status().state.progress; }
    /// The mesh on the device: vec3 positions, uvec3 triangles.
    const taskpool::gpu::Buffer& positions() const { return positions_; }
    const taskpool::gpu::Buffer& triangles() const { return triangles_; }

    const taskpool::pool::PoolStatus& status() const { return pool_.status(); }
    const taskpool::pool::Pool& pool() const { return pool_; }
    const Config& config() const { return config_; }
    /// Frees what only the build needs; the next prepare() allocates it again.
    void release_scratch();

    Tree read_back() const;

  private:
    taskpool::gpu::Device* device_;
    Config config_;
    taskpool::pool::Pool pool_;
    taskpool::gpu::Buffer positions_, triangles_, input_, primitives_[2], nodes_, order_, scratch_;
    std::uint32_t triangle_count_ = 0;
    bool first_launch_ = true;
};

/// Names of the build's phases, for traces and reports.
std::span<const std::string> phase_names();

}  // namespace structures::bvh
