#include "tests/experiments/cli/fake_rows.hpp"

#include <csignal>
#include <stdexcept>
#include <utility>

namespace tests {
namespace {

using structures::Parameter;
using structures::Samples;
using structures::Settings;
using taskpool::gpu::Device;

const Parameter kMethodParameters[] = {
    {"width", std::int64_t{8}, "a number to sweep", {}, 1, 64},
    {"scale", 1.0, "a factor of the times", {}, 0, 1000},
    {"flip", std::int64_t{0}, "answer this many points wrongly", {}, 0, 1e6},
    {"fail",
     std::string("never"),
     "where to throw, or to answer too few points",
     {"never", "create again", "prepare", "build", "query", "size"}},
    {"kill_at", std::int64_t{0}, "kill the process at this query", {}, 0, 1e6},
    {"heat", false, "pretend to have statistics"},
    {"resolution", std::int64_t{8}, "a number that shares its name with a list", {}, 1, 64},
    {"exact", false, "claim to be exact"},
};

/// Shadows in stripes of 64 points; 'times' that depend on the number of queries only.
class Stripes : public shadows::Method {
  public:
    explicit Stripes(const Settings& settings) : settings_(settings) {}

    void prepare(const structures::geometry::TriangleMesh&) override { fail_at("prepare"); }
    Samples build(const structures::geometry::Light&) override {
        fail_at("build");
        return {{"build_ms", 2 * settings_.real("scale"), "ms"}, {"memory_bytes", 1e6, "bytes"}};
    }
    Samples query(const shadows::Points& points, shadows::Visibility& visible) override {
        fail_at("query");
        fail_at("create again");
        if (++queries_ == settings_.integer("kill_at")) std::raise(SIGKILL);
        visible.words.assign(points.count() / 32, 0);
        for (std::size_t w = 0; w < visible.words.size(); ++w)
            visible.words[w] = w / 2 % 2 ? 0xffffffffu : 0u;
        std::int64_t left = settings_.integer("flip");
        for (std::uint32_t i = 0; i < points.count() && left > 0; ++i) {
            if (points.host().primitive[i] == shadows::kNoPrimitive) continue;
            visible.words[i / 32] ^= 1u << (i % 32);
            --left;
        }
        if (settings_.text("fail") == "size") visible.words.pop_back();
        if (settings_.boolean("heat")) heat_.assign(points.count(), 3.0f);
        return {{"query_ms", settings_.real("scale") * (10 + double(queries_ % 3)), "ms"}};
    }
    std::vector<float> heat() override { return heat_; }
    bool claims_exact() const override { return settings_.boolean("exact"); }

  private:
    void fail_at(const char* place) const {
        if (settings_.text("fail") == place)
            throw std::runtime_error(std::string("broken on purpose in ") + place);
    }
    Settings settings_;
    std::int64_t queries_ = 0;
    std::vector<float> heat_;
};

/// "create again" fails in a query first, and then whenever there was such an object before.
std::unique_ptr<shadows::Method> create_method(Device&, const Settings& settings) {
    static bool before = false;
    if (settings.text("fail") == "create again" && std::exchange(before, true))
        throw std::runtime_error("broken on purpose in create");
    return std::make_unique<Stripes>(settings);
}
std::span<const Parameter> method_parameters() { return kMethodParameters; }

const Parameter kTreeParameters[] = {
    {"leaf_size", std::int64_t{4}, "triangles per leaf", {}, 1, 64},
    {"invalid", false, "let validate() find a fault"},
};

class EmptyJob : public taskpool::pool::Job {
  public:
    void restart() override {}
    void record(taskpool::gpu::Recorder&) override {}
    bool advance() override { return false; }
};

class FakeTree : public structures::Builder {
  public:
    explicit FakeTree(const Settings& settings) : settings_(settings) {}
    std::size_t required_bytes(std::size_t triangles) const override { return 8 * triangles; }
    void prepare(const structures::geometry::TriangleMesh& mesh) override {
        triangles_ = mesh.triangle_count();
    }
    taskpool::pool::Job& job() override { return job_; }
    Samples metrics() override {
        return {{"sah_cost", 100.0 / double(settings_.integer("leaf_size"))},
                {"nodes", double(triangles_)}};
    }
    std::vector<std::string> validate() override {
        if (settings_.boolean("invalid")) return {"node 7 is an orphan"};
        return {};
    }
    std::uint64_t fingerprint() override { return triangles_; }

  private:
    Settings settings_;
    EmptyJob job_;
    std::size_t triangles_ = 0;
};

std::unique_ptr<structures::Builder> create_tree(Device&, const Settings& settings) {
    return std::make_unique<FakeTree>(settings);
}
std::span<const Parameter> tree_parameters() { return kTreeParameters; }

const shadows::MethodRow kMethods[] = {
    {"stripes", "shadows in stripes", method_parameters, create_method},
    {"rival", "the same stripes by another name", method_parameters, create_method},
};
const structures::StructureRow kStructures[] = {
    {"fake_tree", "no tree at all", tree_parameters, create_tree},
};

}  // namespace

experiments::measure::Registries fake_registries() { return {kStructures, kMethods}; }

}  // namespace tests
