// Embree's own builder as a structure: the rival of every build time. Its tree cannot be looked
// into.
#include "structures/embree/scene.hpp"
#include "structures/structure.hpp"

namespace structures::embree {
namespace {

/// The build runs on the host, when the (empty) launch has finished.
struct BuildJob final : taskpool::pool::Job {
    BuildJob(unsigned threads, Quality build_quality, bool build_robust)
        : scene(threads), quality(build_quality), robust(build_robust) {}
    void restart() override {}
    void record(taskpool::gpu::Recorder&) override {}
    bool advance() override {
        milliseconds = scene.build(quality, robust);
        return false;
    }
    Scene scene;
    Quality quality;
    bool robust;
    double milliseconds = 0;
};

class EmbreeBuilder final : public Builder {
  public:
    explicit EmbreeBuilder(const Settings& settings)
        : job_(static_cast<unsigned>(settings.integer("threads")),
               quality_from(settings.text("quality")), settings.boolean("robust")) {}

    /// 0: it builds in host memory.
    std::size_t required_bytes(std::size_t) const override { return 0; }
    void prepare(const geometry::TriangleMesh& mesh) override { job_.scene.load(mesh); }
    taskpool::pool::Job& job() override { return job_; }
    Samples metrics() override {
        return {{"build_ms", job_.milliseconds, "ms"},
                {"memory_bytes", double(job_.scene.memory_bytes()), "bytes"}};
    }
    /// Embree does not show its nodes: nothing to check.
    std::vector<std::string> validate() override { return {}; }
    /// Nor to compare.
    std::uint64_t fingerprint() override { return 0; }

  private:
    BuildJob job_;
};

std::span<const Parameter> parameters() {
    static const Parameter all[] = {
        {"quality", std::string("medium"), "Embree's build quality", {"low", "medium", "high"}},
        {"robust", true, "build for watertight traversal, as the shadow methods do"},
        {"threads", std::int64_t{0}, "threads (0: all cores)", {}, 0, 1024},
    };
    return all;
}

std::unique_ptr<Builder> create(taskpool::gpu::Device&, const Settings& settings) {
    return std::make_unique<EmbreeBuilder>(settings);
}

}  // namespace

std::span<const StructureRow> rows() {
    static const StructureRow all[] = {{"embree",
                                        "Embree's BVH, built on the CPU: a rival for build times",
                                        &parameters, &create}};
    return all;
}

}  // namespace structures::embree
