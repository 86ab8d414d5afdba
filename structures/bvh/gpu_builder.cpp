#include "structures/bvh/gpu_builder.hpp"

#include "structures/bvh/fingerprint.hpp"
#include "structures/bvh/quality.hpp"
#include "structures/bvh/validate.hpp"

namespace structures::bvh {
namespace {

std::vector<Parameter> make_parameters() {
    return {
        {"split",
         std::string("binned_sah"),
         "how ranges are split",
         {"binned_sah", "spatial_median"}},
        {"leaf_rule",
         std::string("sah"),
         "when a range of at most max_leaf_size triangles becomes a leaf: when cheaper, or always",
         {"sah", "count"}},
        {"max_leaf_size", std::int64_t{4}, "triangles per leaf at most", {}, 1, 8},
        {"traversal_cost", 3.0, "SAH cost of visiting an inner node", {}, 0, 1e6},
        {"intersection_cost", 2.0, "SAH cost of testing a triangle", {}, 1e-6, 1e6},
        {"max_depth", std::int64_t{64}, "no leaf lies deeper; the root has depth 0", {}, 33, 1024},
        {"deterministic", false, "the same tree, bit for bit, on every device"},
        {"policy", std::string("bitmap"), "how the task pool schedules", {"bitmap", "scan"}},
        {"slots", std::int64_t{4096}, "slots of the task pool to begin with", {}, 64, 1 << 24},
        {"workgroups",
         std::int64_t{0},
         "persistent workgroups (0: as many as the device keeps busy)",
         {},
         0,
         65535},
        {"time_budget_ms", std::int64_t{500}, "time after which a launch yields", {}, 1, 4000},
        {"trace", false, "record every chunk for a Chrome trace"},
    };
}

std::unique_ptr<Builder> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<GpuBuilder>(device, build_config(settings), settings.boolean("epo"));
}

std::span<const Parameter> row_parameters() {
    static const std::vector<Parameter> parameters = [] {
        std::vector<Parameter> all = make_parameters();
        all.push_back({"epo", false, "measure the end-point overlap of the finished tree too"});
        return all;
    }();
    return parameters;
}

/// Chunks whose trace is kept.
constexpr std::uint32_t kTraceCapacity = 1u << 20;

}  // namespace

std::span<const Parameter> build_parameters() {
    static const std::vector<Parameter> parameters = make_parameters();
    return parameters;
}

Config build_config(const Settings& settings) {
    Config config;
    config.split =
        settings.text("split") == "binned_sah" ? Split::binned_sah : Split::spatial_median;
    config.leaf_by_cost = settings.text("leaf_rule") == "sah";
    config.max_leaf_size = static_cast<std::uint32_t>(settings.integer("max_leaf_size"));
    config.costs = {settings.real("traversal_cost"), settings.real("intersection_cost")};
    config.max_depth = static_cast<std::uint32_t>(settings.integer("max_depth"));
    config.deterministic = settings.boolean("deterministic");
    config.pool.policy = taskpool::pool::policy_from(settings.text("policy"));
    config.pool.slots = static_cast<std::uint32_t>(settings.integer("slots"));
    config.pool.subgroups = static_cast<std::uint32_t>(settings.integer("workgroups"));
    config.pool.time_budget_ms = static_cast<std::uint32_t>(settings.integer("time_budget_ms"));
    config.pool.trace_capacity = settings.boolean("trace") ? kTraceCapacity : 0;
    return config;
}

GpuBuilder::GpuBuilder(taskpool::gpu::Device& device, const Config& config, bool measure_epo)
    : build_(device, config), measure_epo_(measure_epo) {}

std::size_t GpuBuilder::required_bytes(std::size_t triangle_count) const {
    return build_.required_bytes(triangle_count);
}

void GpuBuilder::prepare(const geometry::TriangleMesh& mesh) {
    mesh_ = &mesh;
    build_.prepare(mesh);
}

Samples GpuBuilder::metrics() {
    const taskpool::pool::PoolStatus& status = build_.status();
    Samples samples = to_samples(
        measure(*mesh_, build_.read_back(), {.costs = build_.config().costs, .epo = measure_epo_}));
    if (!measure_epo_) std::erase_if(samples, [](const Sample& s) { return s.metric == "epo"; });
    const auto add = [&](const char* metric, double value) { samples.push_back({metric, value}); };
    add("degenerate", double(build_.triangle_count() - status.state.progress));
    add("tasks", double(status.state.spawned) + 1);
    add("pool_peak", status.state.peak_live);
    add("pool_chunks", status.state.chunks);
    add("pool_claims", status.state.claims);
    add("pool_failed_claims", status.state.failed_claims);
    add("pool_polls", status.state.polls);
    add("pool_growths", status.growths);
    return samples;
}

std::vector<std::string> GpuBuilder::validate() {
    const Limits limits{.max_leaf_size = build_.config().max_leaf_size,
                        .max_depth = build_.config().max_depth,
                        .tight = true};
    return bvh::validate(*mesh_, build_.read_back(), limits);
}

std::uint64_t GpuBuilder::fingerprint() { return bvh::fingerprint(build_.read_back()); }

std::string GpuBuilder::trace() {
    if (build_.config().pool.trace_capacity == 0) return {};
    std::uint32_t dropped = 0;
    const auto records = build_.pool().read_trace(dropped);
    return taskpool::pool::chrome_trace(records, phase_names());
}

const StructureRow kGpuRow{"bvh", "binary BVH built on the GPU by the task pool", row_parameters,
                           create};

}  // namespace structures::bvh
