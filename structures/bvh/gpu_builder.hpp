// The GPU build as a row of the registry, `bvh`.
#pragma once

#include "structures/bvh/bvh.hpp"
#include "structures/structure.hpp"

namespace structures::bvh {

class GpuBuilder final : public Builder {
  public:
    /// `measure_epo`: metrics() reports the end-point overlap too, which takes seconds per million
    /// triangles on the CPU.
    GpuBuilder(taskpool::gpu::Device& device, const Config& config, bool measure_epo);

    std::size_t required_bytes(std::size_t triangle_count) const override;
    void prepare(const geometry::TriangleMesh& mesh) override;
    taskpool::pool::Job& job() override { return build_; }
    Samples metrics() override;
    std::vector<std::string> validate() override;
    std::uint64_t fingerprint() override;
    std::string trace() override;

  private:
    BvhBuild build_;
    const geometry::TriangleMesh* mesh_ = nullptr;
    bool measure_epo_;
};

/// The parameters of a GPU build, for `bvh` here and for methods that build one.
std::span<const Parameter> build_parameters();
/// From settings that hold at least build_parameters().
Config build_config(const Settings& settings);

extern const StructureRow kGpuRow;

}  // namespace structures::bvh
