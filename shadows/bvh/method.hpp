// The BVH as a shadow method; see query.hpp.
#pragma once

#include <memory>

#include "shadows/bvh/query.hpp"
#include "shadows/bvh/tree_source.hpp"
#include "shadows/method.hpp"

namespace shadows::bvh {

class BvhMethod final : public Method {
  public:
    BvhMethod(taskpool::gpu::Device& device, const structures::Settings& settings);

    void prepare(const structures::geometry::TriangleMesh& mesh) override;
    /// build_ms (binary tree and collapse), memory_bytes, nodes, counters of the pool.
    structures::Samples build(const structures::geometry::Light& light) override;
    /// query_ms, incomplete, deferred and, with statistics, visited nodes and tested triangles.
    structures::Samples query(const Points& points, Visibility& visible) override;
    std::vector<float> heat() override { return query_.heat(); }
    bool claims_exact() const override { return config_.exact(); }

  private:
    taskpool::gpu::Device& device_;
    QueryConfig config_;
    Query query_;
    TreeSource source_;
    structures::bvh::wide::WideBuilder wide_;
    taskpool::gpu::Timestamps times_;
    structures::geometry::Light light_;
};

}  // namespace shadows::bvh
