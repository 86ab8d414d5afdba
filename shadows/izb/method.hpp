// The irregular z-buffer as a shadow method; see query.hpp.
#pragma once

#include "shadows/izb/query.hpp"
#include "shadows/method.hpp"

namespace shadows::izb {

class IzbMethod final : public Method {
  public:
    IzbMethod(taskpool::gpu::Device& device, const structures::Settings& settings);

    void prepare(const structures::geometry::TriangleMesh& mesh) override;
    /// Only takes the light: the grid depends on the points, and is part of the query.
    structures::Samples build(const structures::geometry::Light& light) override;
    /// query_ms (on the host's clock: QueryResult), memory_bytes, incomplete, cells, and counts of
    /// the work.
    structures::Samples query(const Points& points, Visibility& visible) override;
    bool claims_exact() const override { return true; }

  private:
    QueryConfig config_;
    Query query_;
};

}  // namespace shadows::izb
