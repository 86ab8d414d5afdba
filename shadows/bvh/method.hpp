// The BVH as a shadow method; see query.hpp.
#pragma once

#include <memory>

#include "shadows/bvh/query.hpp"
#include "shadows/method.hpp"
#include "structures/bvh/tree.hpp"

namespace shadows::bvh {

class BvhMethod final : public Method {
  public:
    BvhMethod(taskpool::gpu::Device& device, std::string build, const QueryConfig& config);

    void prepare(const structures::geometry::TriangleMesh& mesh) override;
    /// build_ms (binary tree and collapse), memory_bytes, nodes.
    structures::Samples build(const structures::geometry::Light& light) override;
    /// query_ms, incomplete, deferred and, with statistics, visited nodes and tested triangles.
    structures::Samples query(const Points& points, Visibility& visible) override;
    std::vector<float> heat() override;
    bool claims_exact() const override { return true; }

  private:
    /// Builds the binary tree and leaves it in `nodes_` and `order_`; milliseconds.
    double build_binary();

    taskpool::gpu::Device& device_;
    std::string build_;
    QueryConfig config_;
    Query query_;
    structures::bvh::wide::WideBuilder wide_;
    taskpool::gpu::Timestamps times_;
    const structures::geometry::TriangleMesh* mesh_ = nullptr;
    structures::geometry::Light light_;
    taskpool::gpu::Buffer positions_, corners_, nodes_, order_;
    std::uint32_t node_count_ = 0, order_count_ = 0;
};

}  // namespace shadows::bvh
