#include "shadows/bvh/method.hpp"

#include <algorithm>

namespace shadows::bvh {
namespace {

using structures::Parameter;
using structures::Samples;
using structures::Settings;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using taskpool::gpu::Recorder;

std::vector<Parameter> make_parameters() {
    const tiles::Limits defaults;
    std::vector<Parameter> all = tree_parameters();
    const Parameter query[] = {
        {"query", std::string("beam"), "how points walk the tree", {"beam", "packet", "lane"}},
        {"statistics", false, "count nodes and triangles per point (slower)"},
        {"stack", std::int64_t{defaults.stack}, "stack entries of a beam or packet", {}, 1, 32},
        {"list",
         std::int64_t{defaults.scratch},
         "triangles a beam collects at a time",
         {},
         64,
         4096},
        {"density",
         std::int64_t{defaults.density},
         "triangles per point a beam may meet",
         {},
         0,
         1e6},
        {"leaf",
         std::string("exact"),
         "leaf test: exact, or a shortcut to measure its errors",
         {"exact", "watertight", "moeller_trumbore", "double"}},
        {"contraction", false, "contract the products of leaf = watertight, as a compiler may"},
        {"bias", 0.0, "move points towards the light by this fraction of the way", {}, 0, 0.1},
    };
    all.insert(all.end(), std::begin(query), std::end(query));
    return all;
}

std::span<const Parameter> parameters() {
    static const std::vector<Parameter> all = make_parameters();
    return all;
}

QueryConfig query_config(const Settings& settings) {
    const std::string& kind = settings.text("query");
    QueryConfig config;
    config.kind = kind == "lane"     ? QueryKind::lane
                  : kind == "packet" ? QueryKind::packet
                                     : QueryKind::beam;
    tiles::Limits& limits = config.limits;
    limits.statistics = settings.boolean("statistics");
    limits.stack = static_cast<std::uint32_t>(settings.integer("stack"));
    limits.scratch = static_cast<std::uint32_t>(settings.integer("list"));
    limits.density = static_cast<std::uint32_t>(settings.integer("density"));
    const std::string& leaf = settings.text("leaf");
    config.leaf = leaf == "watertight"         ? Leaf::watertight
                  : leaf == "moeller_trumbore" ? Leaf::moeller_trumbore
                  : leaf == "double"           ? Leaf::double_precision
                                               : Leaf::exact;
    config.contraction = settings.boolean("contraction");
    config.bias = static_cast<float>(settings.real("bias"));
    return config;
}

std::unique_ptr<Method> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<BvhMethod>(device, settings);
}

}  // namespace

BvhMethod::BvhMethod(taskpool::gpu::Device& device, const Settings& settings)
    : device_(device),
      config_(query_config(settings)),
      query_(device, config_),
      source_(device, settings),
      wide_(device),
      times_(device, 2) {}

void BvhMethod::prepare(const TriangleMesh& mesh) { source_.prepare(mesh); }

Samples BvhMethod::build(const Light& light) {
    light_ = light;
    double milliseconds = source_.build();
    wide_.prepare(source_.capacity());
    const structures::bvh::wide::BinaryTree binary = source_.tree();
    for (bool first = true; first || wide_.pending() > 0; first = false) {
        times_.clear();
        Recorder recorder(device_);
        recorder.timestamp(times_, "begin");
        if (first)
            wide_.record(recorder, binary);
        else
            wide_.record_rest(recorder, binary);
        recorder.timestamp(times_, "end");
        device_.run(recorder);
        milliseconds += times_.milliseconds("begin", "end");
    }
    Samples samples = source_.counters();
    samples.push_back({"build_ms", milliseconds, "ms"});
    samples.push_back({"nodes", double(wide_.header().node_count)});
    using structures::bvh::wide::WideBuilder;
    const std::size_t wide_bytes = WideBuilder::tree_bytes(source_.capacity()) +
                                   WideBuilder::scratch_bytes(source_.capacity());
    samples.push_back({"memory_bytes", double(source_.memory_bytes() + wide_bytes), "bytes"});
    return samples;
}

Samples BvhMethod::query(const Points& points, Visibility& visible) {
    query_.prepare(points.count());
    times_.clear();
    Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    query_.record(recorder, wide_.tree(), points.address(), points.count(), light_);
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    visible = query_.visibility();
    Samples samples = query_.counters(points.valid_count());
    samples.push_back({"query_ms", times_.milliseconds("begin", "end"), "ms"});
    return samples;
}

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"bvh", "any-hit in an 8-wide BVH on the GPU, exact leaf test", &parameters, &create},
    };
    return all;
}

}  // namespace shadows::bvh
