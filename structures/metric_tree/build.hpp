// Metric trees built on the device by the task pool, for one light.
//
//     MetricTreeBuild build(device, {.builder = Builder::insertion});
//     build.prepare(clustering, mesh);              // allocates and uploads
//     build.set_light(light);
//     taskpool::pool::run(device, build);
//     MetricTreeView tree = build.view();           // for queries
//
// First every cluster becomes a node without subtrees, or a special one, or is left out
// (elements.comp); then the nodes are linked:
//   insertion  one by one, by all lanes at once (insertion.comp; Deves et al. 2018, section 5.3)
//   median     from the top down: pivot, distances, median, three-way partition, children (median.comp)
#pragma once

#include "structures/geometry/light.hpp"
#include "structures/metric_tree/tree.hpp"
#include "taskpool/pool/job.hpp"
#include "taskpool/pool/pool.hpp"

namespace structures::metric_tree {

enum class BuilderKind { insertion, median };

struct BuildConfig {
    BuilderKind builder = BuilderKind::insertion;
    bool cull_facing = false;  ///< leave out clusters that face away from the light: exact for closed
                               ///< meshes of one winding only
    std::uint64_t seed = 1;    ///< order of insertion, or choice of pivots
    taskpool::pool::PoolConfig pool;
};

/// Device addresses of a finished tree.
struct MetricTreeView {
    std::uint64_t header = 0;     ///< MetricHeader
    std::uint64_t nodes = 0;      ///< MetricNode[]
    std::uint64_t clusters = 0;   ///< Cluster[]
    std::uint64_t triangles = 0;  ///< ClusterTriangle[]: three corners and the primitive, cluster after cluster
    std::uint64_t special = 0;    ///< uint[]: indices of special clusters
};

class MetricTreeBuild final : public taskpool::pool::Job {
  public:
    MetricTreeBuild(taskpool::gpu::Device& device, const BuildConfig& config);

    static std::size_t required_bytes(std::size_t clusters, std::size_t triangles);
    void prepare(const Clustering& clustering, const geometry::TriangleMesh& mesh);
    void set_light(const geometry::Light& light);
    /// Uploads a tree built elsewhere, from the same clustering.
    void load(const Tree& tree);

    void restart() override;
    void record(taskpool::gpu::Recorder& recorder) override;
    bool advance() override;
    double progress() const override;

    MetricTreeView view() const;
    const taskpool::pool::PoolStatus& status() const;
    MetricHeader header() const;
    Tree read_back() const;
};

}  // namespace structures::metric_tree
