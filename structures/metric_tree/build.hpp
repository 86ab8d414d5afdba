// Metric trees built on the device by the task pool, for one light.
//
//     MetricTreeBuild build(device, {.builder = BuilderKind::insertion});
//     build.prepare(clustering, mesh);              // allocates and uploads
//     build.set_light(light);
//     taskpool::pool::run(device, build);
//     MetricTreeView tree = build.view();           // for queries
//
// First every cluster becomes a node without subtrees, or a special one, or is left out
// (elements.comp); then the nodes are linked:
//   insertion  one by one, by all lanes at once (insertion.comp; Deves et al. 2018, section 5.3)
//   median     from the top down: pivot, delta, distances, three-way partition, children
//              (median.comp); delta is the median distance, after Uhlmann 1991
//   cost       likewise; delta is what is expected to cost queries least
// Trees of the latter two are the same whatever the pool does.
#pragma once

#include <memory>

#include "structures/geometry/gather_triangles.hpp"
#include "structures/geometry/light.hpp"
#include "structures/metric_tree/tree.hpp"
#include "taskpool/pool/job.hpp"
#include "taskpool/pool/pool.hpp"

namespace structures::metric_tree {

enum class BuilderKind { insertion, median, cost };

struct BuildConfig {
    BuilderKind builder = BuilderKind::insertion;
    bool cull_facing = false;  ///< leave out clusters that face away from the light: exact for
                               ///< closed meshes of one winding only
    std::uint64_t seed = 1;    ///< order of insertion, or choice of samples
    taskpool::pool::PoolConfig pool;
};

/// Device addresses of a finished tree.
struct MetricTreeView {
    std::uint64_t header = 0;     ///< MetricHeader
    std::uint64_t nodes = 0;      ///< MetricNode[]
    std::uint64_t clusters = 0;   ///< Cluster[]
    std::uint64_t triangles = 0;  ///< geometry::CornerTriangle[], cluster after cluster
};

class MetricTreeBuild final : public taskpool::pool::Job {
  public:
    MetricTreeBuild(taskpool::gpu::Device& device, const BuildConfig& config);
    ~MetricTreeBuild() override;

    /// Device memory of a build, pool (before any growth) and output: 128 bytes per cluster and 40
    /// per triangle beside a constant; from the top down, between 8 and 9 more per cluster.
    std::size_t required_bytes(std::size_t clusters, std::size_t triangles) const;
    /// Throws std::invalid_argument for kLinkMask or more clusters.
    void prepare(const Clustering& clustering, const geometry::TriangleMesh& mesh);
    /// The light of builds from the next restart() on; before, a point light at the origin.
    void set_light(const geometry::Light& light) { light_ = light; }
    /// Address of a mask with a bit per cluster, of those that builds from now on keep; 0: all. It
    /// has to be written when the first recorded launch runs.
    void set_mask(std::uint64_t keep) { keep_ = keep; }
    /// Uploads a tree built elsewhere, from the clustering that was prepared. Throws
    /// std::invalid_argument if the number of nodes is another.
    void load(const Tree& tree);

    /// Throws std::invalid_argument for a directional light without a direction.
    void restart() override;
    void record(taskpool::gpu::Recorder& recorder) override;
    bool advance() override;
    double progress() const override;

    MetricTreeView view() const;
    /// The frame of set_light() and the mesh.
    LightFrame frame() const;
    /// Whether some of the clusters prepared are no balls.
    bool has_capsules() const { return capsules_; }
    const BuildConfig& config() const { return config_; }
    const taskpool::pool::PoolStatus& status() const;
    MetricHeader header() const;
    /// Links without the bits above kLinkMask.
    Tree read_back() const;

  private:
    struct Kernels;

    taskpool::gpu::Device* device_;
    BuildConfig config_;
    geometry::GatherTriangles gather_;
    geometry::Light light_;
    geometry::Aabb bounds_;
    std::uint32_t cluster_count_ = 0;
    bool capsules_ = false;
    std::uint64_t keep_ = 0;
    taskpool::gpu::Buffer clusters_, nodes_, triangles_, header_;
    std::unique_ptr<Kernels> kernels_[2][2];  ///< [directional][capsules], made when first needed
    Kernels* active_ = nullptr;
    bool begun_ = false;  ///< elements.comp has been recorded
};

}  // namespace structures::metric_tree
