// Clusters made on the device by the task pool: clustering.hpp for meshes that change.
//
//     ClusterBuild build(device, {.max_triangles = 16});
//     build.prepare(mesh);                          // allocates and uploads
//     taskpool::pool::run(device, build);
//     Clustering clusters = build.read_back();      // sound as validate() has it
//
// Morton codes and their sort, chunks split by k-means (cluster_split.comp), then volumes in single
// precision (cluster_fit.comp). The clusters are not those of cluster(), but of the same making;
// the same mesh always gives the same ones on a device.
#pragma once

#include "structures/metric_tree/clustering.hpp"
#include "taskpool/pool/job.hpp"
#include "taskpool/pool/pool.hpp"
#include "taskpool/primitives/radix_sort.hpp"

namespace structures::metric_tree {

class ClusterBuild final : public taskpool::pool::Job {
  public:
    /// Chunks of few triangles must not stay with the subgroup that spawns them.
    static constexpr taskpool::pool::PoolConfig kPool{.private_chunks = 1};

    /// Throws std::invalid_argument as cluster() does.
    ClusterBuild(taskpool::gpu::Device& device, const ClusterConfig& config,
                 const taskpool::pool::PoolConfig& pool = kPool);

    /// Likewise. Corners have to be finite or belong to degenerate triangles alone.
    void prepare(const geometry::TriangleMesh& mesh);

    void restart() override;
    void record(taskpool::gpu::Recorder& recorder) override;
    bool advance() override;
    double progress() const override;

    const taskpool::pool::PoolStatus& status() const { return pool_.status(); }
    Clustering read_back() const;

  private:
    enum class Stage { sort, split, list, fit, done };
    void record_sort(taskpool::gpu::Recorder& recorder);
    void record_fit(taskpool::gpu::Recorder& recorder);

    taskpool::gpu::Device* device_;
    ClusterConfig config_;
    taskpool::gpu::Kernel codes_kernel_, fit_kernel_;
    taskpool::primitives::RadixSort sort_;
    taskpool::primitives::Compact compact_;
    taskpool::pool::Pool pool_;
    geometry::Aabb bounds_;
    std::uint32_t triangle_count_ = 0, cluster_count_ = 0;
    Stage stage_ = Stage::done;
    taskpool::gpu::Buffer positions_, triangles_;
    taskpool::gpu::Buffer codes_, sorted_codes_, ids_, order_, scratch_;
    taskpool::gpu::Buffer
        marks_;  ///< by place in the order: how many triangles begin a cluster there
    taskpool::gpu::Buffer firsts_;  ///< of clusters, in the order
    taskpool::gpu::Buffer counts_;  ///< triangles kept, clusters
    taskpool::gpu::Buffer clusters_;
};

}  // namespace structures::metric_tree
