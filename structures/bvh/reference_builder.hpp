// The CPU builders as a row of the registry, `bvh_reference`: a yardstick that experiments can
// name.
#pragma once

#include "structures/bvh/reference.hpp"
#include "structures/structure.hpp"

namespace structures::bvh {

class ReferenceBuilder final : public Builder {
  public:
    explicit ReferenceBuilder(const ReferenceConfig& config) : job_(config) {}

    /// 0: it builds in host memory.
    std::size_t required_bytes(std::size_t) const override { return 0; }
    void prepare(const geometry::TriangleMesh& mesh) override;
    taskpool::pool::Job& job() override { return job_; }
    Samples metrics() override;
    std::vector<std::string> validate() override;
    std::uint64_t fingerprint() override;

    /// The finished tree. Throws std::logic_error before the first build.
    const Tree& tree() const;

  private:
    /// The whole build happens on the host, when the (empty) launch has finished.
    struct BuildJob final : taskpool::pool::Job {
        explicit BuildJob(const ReferenceConfig& c) : config(c) {}
        void restart() override { tree = {}; }
        void record(taskpool::gpu::Recorder&) override {}
        bool advance() override;

        ReferenceConfig config;
        const geometry::TriangleMesh* mesh = nullptr;
        Tree tree;  ///< no nodes at all: not built
    };
    BuildJob job_;
};

/// The parameters of `bvh_reference`, and their meaning.
std::span<const Parameter> reference_parameters();
ReferenceConfig reference_config(const Settings& settings);

/// The registry row.
extern const StructureRow kReferenceRow;

}  // namespace structures::bvh
