#include "shadows/metric_tree/method.hpp"

#include <algorithm>
#include <chrono>

std::span<const taskpool::gpu::Shader> shadows_metric_tree_shaders();

namespace shadows::metric_tree {
namespace {

using namespace structures::metric_tree;
using structures::Parameter;
using structures::Samples;
using structures::Settings;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using taskpool::gpu::Recorder;

constexpr std::uint32_t kStack = 1024;

std::span<const Parameter> parameters() {
    static const std::vector<Parameter> all = [] {
        std::vector<Parameter> list = tree_parameters();
        const tiles::Limits defaults;
        const Parameter query[] = {
            {"query",
             std::string("beam"),
             "how points walk the tree",
             {"beam", "packet", "lane", "stackless"}},
            {"statistics", false, "count nodes and triangles per point (slower)"},
            {"stack", std::int64_t{kStack}, "stack entries of a beam or packet", {}, 2, kStack},
            {"density", std::int64_t{16}, "triangles per point a beam may meet", {}, 0, 1e6},
            {"cull_receivers", false, "leave out clusters that can shadow no point asked about"},
            {"depth_test", true, "leave out subtrees behind the point"},
            {"interval_test", true, "leave out overlapping subtrees out of reach"},
            {"slab_test", true, "leave out clusters whose slab is missed"},
        };
        list.insert(list.end(), std::begin(query), std::end(query));
        return list;
    }();
    return all;
}

tiles::Limits limits(const Settings& settings) {
    tiles::Limits limits;
    limits.statistics = settings.boolean("statistics");
    limits.stack = static_cast<std::uint32_t>(settings.integer("stack"));
    limits.scratch = limits.stack;
    limits.density = static_cast<std::uint32_t>(settings.integer("density"));
    limits.point_stack = 64;
    return limits;
}

tiles::Shaders shaders(const Settings& settings) {
    const std::string& kind = settings.text("query");
    const bool per_point = kind == "lane" || kind == "stackless";
    const auto find = [](const std::string& name) {
        return &taskpool::gpu::find_shader(shadows_metric_tree_shaders(),
                                           "shadows/metric_tree/" + name + ".comp");
    };
    return {find(per_point ? "lane" : kind),
            find("deferred"),
            per_point,
            {{20, settings.boolean("depth_test")},
             {21, settings.boolean("interval_test")},
             {22, settings.boolean("slab_test")},
             {23, kind == "stackless"}}};
}

std::unique_ptr<Method> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<MetricTreeMethod>(device, settings);
}

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

}  // namespace

MetricTreeMethod::MetricTreeMethod(taskpool::gpu::Device& device, const Settings& settings)
    : device_(device),
      settings_(settings),
      reference_(reference_config(settings)),
      build_(device, build_config(settings)),
      limits_(limits(settings)),
      shaders_(shaders(settings)),
      times_(device, 2) {
    if (!settings.boolean("cull_receivers")) return;
    if (reference_)
        throw structures::SettingError("cull_receivers",
                                       "'cull_receivers' needs a tree built on the GPU");
    receivers_.emplace(device);
}

void MetricTreeMethod::prepare(const TriangleMesh& mesh) {
    const auto begin = std::chrono::steady_clock::now();
    clustering_ = make_clusters(device_, mesh, settings_);
    cluster_ms_ = milliseconds_since(begin);
    bounds_ = mesh.bounds();
    triangle_count_ = clustering_.order.size();
    build_.prepare(clustering_, mesh);
    // No code for capsules where there are none.
    std::optional<tiles::TileQuery>& query = queries_[build_.has_capsules()];
    if (!query) {
        tiles::Shaders specialised = shaders_;
        specialised.constants.emplace_back(24, build_.has_capsules());
        query.emplace(device_, limits_, std::move(specialised));
    }
    query_ = &*query;
}

double MetricTreeMethod::choose_casters() {
    if (!points_)
        throw std::logic_error("metric_tree: cull_receivers needs expect() before build()");
    times_.clear();
    Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    receivers_->record(
        recorder,
        {build_.frame(), build_.view().clusters,
         static_cast<std::uint32_t>(clustering_.clusters.size()), build_.has_capsules()},
        *points_);
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    build_.set_mask(receivers_->mask());
    return times_.milliseconds("begin", "end");
}

double MetricTreeMethod::build_on_host(const Light& light) {
    const auto begin = std::chrono::steady_clock::now();
    const Tree tree = build_reference(clustering_, bounds_, light, *reference_);
    const double milliseconds = milliseconds_since(begin);
    build_.load(tree);
    return milliseconds;
}

Samples MetricTreeMethod::build(const Light& light) {
    light_ = light;
    build_.set_light(light);
    double milliseconds = receivers_ ? choose_casters() : 0;
    milliseconds += reference_ ? build_on_host(light) : taskpool::pool::run(device_, build_).gpu_ms;
    const MetricHeader header = build_.header();
    Samples samples{{"build_ms", milliseconds, "ms"},
                    {"cluster_ms", cluster_ms_, "ms"},
                    {"casters_total", double(header.cluster_count)},
                    {"casters_inserted", double(header.inserted)},
                    {"culled_facing", double(header.culled_facing)},
                    {"culled_unseen", double(header.culled_unseen)},
                    {"special_clusters", double(header.special_count)},
                    {"bucketed_clusters", double(header.bucketed)},
                    {"depth_max", double(header.depth_max)},
                    {"memory_bytes",
                     double(build_.required_bytes(header.cluster_count, triangle_count_) +
                            (receivers_ ? receivers_->memory_bytes() : 0)),
                     "bytes"}};
    if (!reference_) {
        const taskpool::pool::PoolStatus& status = build_.status();
        samples.push_back({"tasks", double(status.state.spawned) + 1});
        samples.push_back({"launches", double(status.launches)});
        samples.push_back({"pool_peak", double(status.state.peak_live)});
    }
    return samples;
}

Samples MetricTreeMethod::query(const Points& points, Visibility& visible) {
    if (receivers_ && &points != points_)
        throw std::logic_error("metric_tree: cull_receivers, but other points than expected");
    query_->prepare(points.count());
    times_.clear();
    Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    query_->record(recorder, build_.view(), points.address(), points.count(), light_);
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    visible = query_->visibility();
    Samples samples = query_->counters(points.valid_count());
    samples.push_back({"query_ms", times_.milliseconds("begin", "end"), "ms"});
    return samples;
}

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"metric_tree", "ternary metric tree over clusters, built on the GPU for each light, exact",
         &parameters, &create},
    };
    return all;
}

}  // namespace shadows::metric_tree
