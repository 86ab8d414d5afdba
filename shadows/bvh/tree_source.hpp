// Where a BVH shadow method gets its binary tree from: the task pool on the GPU, or one of the
// careful CPU builders, so that what a better tree is worth can be measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "structures/bvh/bvh.hpp"
#include "structures/bvh/reference.hpp"
#include "structures/bvh/wide/wide.hpp"
#include "structures/parameters.hpp"
#include "structures/sample.hpp"

namespace shadows::bvh {

/// Parameter `build`, and those of the GPU build but its `split`.
std::vector<structures::Parameter> tree_parameters();

class TreeSource {
  public:
    TreeSource(taskpool::gpu::Device& device, const structures::Settings& settings);

    /// Uploads; not part of a build's time. `mesh` must outlive the source's use.
    void prepare(const structures::geometry::TriangleMesh& mesh);
    /// Builds the tree; returns the milliseconds: device time on the GPU, wall time on the CPU.
    double build();
    /// Device memory of a build: the tree and what building it takes; for a CPU build the tree.
    std::size_t memory_bytes() const;
    /// Counters of the last build on the pool; nothing for a CPU build.
    structures::Samples counters() const;

    structures::bvh::wide::BinaryTree tree() const;
    structures::bvh::wide::Capacity capacity() const;

  private:
    taskpool::gpu::Device& device_;
    std::optional<structures::bvh::BvhBuild> gpu_;
    structures::bvh::ReferenceConfig reference_;
    const structures::geometry::TriangleMesh* mesh_ = nullptr;
    taskpool::gpu::Buffer positions_, triangles_, nodes_, order_;  // of a CPU build
    std::uint32_t node_count_ = 0, order_count_ = 0;
};

}  // namespace shadows::bvh
