// The ternary metric tree as a shadow method (F. Deves et al. 2018): triangles clustered once, a
// tree over the clusters built for each light, points walking it.
#pragma once

#include <array>
#include <optional>

#include "shadows/method.hpp"
#include "shadows/metric_tree/receivers.hpp"
#include "shadows/tiles/tile_query.hpp"
#include "structures/metric_tree/settings.hpp"

namespace shadows::metric_tree {

class MetricTreeMethod final : public Method {
  public:
    MetricTreeMethod(taskpool::gpu::Device& device, const structures::Settings& settings);

    void prepare(const structures::geometry::TriangleMesh& mesh) override;
    void expect(const Points& points) override { points_ = &points; }
    /// build_ms (the tree for this light), cluster_ms (once, by prepare), memory_bytes, what became
    /// of the clusters, and counters of the pool.
    structures::Samples build(const structures::geometry::Light& light) override;
    /// query_ms, incomplete, deferred and, with statistics, visited nodes and tested triangles.
    structures::Samples query(const Points& points, Visibility& visible) override;
    std::vector<float> heat() override { return query_->heat(); }
    bool claims_exact() const override { return !build_.config().cull_facing; }

  private:
    /// Records and runs the choice of clusters that may shadow a point; milliseconds.
    double choose_casters();
    double build_on_host(const structures::geometry::Light& light);

    taskpool::gpu::Device& device_;
    structures::Settings settings_;
    /// Absent: built on the device.
    std::optional<structures::metric_tree::ReferenceConfig> reference_;
    structures::metric_tree::MetricTreeBuild build_;
    tiles::Limits limits_;
    tiles::Shaders shaders_;
    std::array<std::optional<tiles::TileQuery>, 2> queries_;  ///< without and with capsules; kept,
                                                              ///< as kernels take long to compile
    tiles::TileQuery* query_ = nullptr;                       ///< the one for the clusters prepared
    std::optional<Receivers> receivers_;  ///< if clusters that shadow no point are left out
    const Points* points_ = nullptr;      ///< expected
    taskpool::gpu::Timestamps times_;
    structures::metric_tree::Clustering clustering_;
    structures::geometry::Aabb bounds_;
    std::size_t triangle_count_ = 0;
    double cluster_ms_ = 0;
    structures::geometry::Light light_;
};

}  // namespace shadows::metric_tree
