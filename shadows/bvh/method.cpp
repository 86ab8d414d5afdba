#include "shadows/bvh/method.hpp"

#include <algorithm>
#include <chrono>

#include "structures/bvh/reference.hpp"

namespace shadows::bvh {
namespace {

using structures::Parameter;
using structures::Samples;
using structures::Settings;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using taskpool::gpu::Buffer;
using taskpool::gpu::Recorder;

std::span<const Parameter> parameters() {
    static const QueryConfig defaults;
    static const Parameter all[] = {
        {"build",
         std::string("sweep_sah"),
         "how the tree is built",
         {"sweep_sah", "object_median", "spatial_median"}},
        {"query", std::string("beam"), "how points walk the tree", {"beam", "packet", "lane"}},
        {"statistics", false, "count nodes and triangles per point (slower)"},
        {"stack", std::int64_t{defaults.stack}, "stack entries of a beam or packet", {}, 1, 32},
        {"list", std::int64_t{defaults.list}, "triangles a beam collects at a time", {}, 64, 4096},
        {"split", std::int64_t{defaults.split}, "triangles before a group is halved", {}, 1},
        {"rounds", std::int64_t{defaults.rounds}, "groups a tile may split into", {}, 1, 256},
    };
    return all;
}

QueryConfig query_config(const Settings& settings) {
    const std::string& kind = settings.text("query");
    QueryConfig config;
    config.kind = kind == "lane"     ? QueryKind::lane
                  : kind == "packet" ? QueryKind::packet
                                     : QueryKind::beam;
    config.statistics = settings.boolean("statistics");
    config.stack = static_cast<std::uint32_t>(settings.integer("stack"));
    config.list = static_cast<std::uint32_t>(settings.integer("list"));
    config.split = static_cast<std::uint32_t>(settings.integer("split"));
    config.rounds = static_cast<std::uint32_t>(settings.integer("rounds"));
    return config;
}

std::unique_ptr<Method> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<BvhMethod>(device, settings.text("build"), query_config(settings));
}

}  // namespace

BvhMethod::BvhMethod(taskpool::gpu::Device& device, std::string build, const QueryConfig& config)
    : device_(device),
      build_(std::move(build)),
      config_(config),
      query_(device, config),
      wide_(device),
      times_(device, 2) {}

void BvhMethod::prepare(const TriangleMesh& mesh) {
    mesh_ = &mesh;
    positions_ = taskpool::gpu::make_buffer<glm::vec3>(device_, mesh.positions, "positions");
    corners_ = taskpool::gpu::make_buffer<glm::uvec3>(device_, mesh.triangles, "triangles");
}

double BvhMethod::build_binary() {
    const auto begin = std::chrono::steady_clock::now();
    structures::bvh::ReferenceConfig config;
    config.rule = build_ == "object_median"    ? structures::bvh::SplitRule::object_median
                  : build_ == "spatial_median" ? structures::bvh::SplitRule::spatial_median
                                               : structures::bvh::SplitRule::sweep_sah;
    const structures::bvh::Tree tree = structures::bvh::build_reference(*mesh_, config);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    nodes_ = taskpool::gpu::make_buffer<structures::bvh::BvhNode>(device_, tree.nodes, "nodes");
    order_ = taskpool::gpu::make_buffer<std::uint32_t>(device_, tree.order, "order");
    node_count_ = static_cast<std::uint32_t>(tree.nodes.size());
    order_count_ = static_cast<std::uint32_t>(tree.order.size());
    return time.count();
}

Samples BvhMethod::build(const Light& light) {
    light_ = light;
    double milliseconds = build_binary();
    const structures::bvh::wide::Capacity capacity{order_count_, node_count_};
    wide_.prepare(capacity);
    const structures::bvh::wide::BinaryTree binary{
        nodes_.address(),   order_.address(), positions_.address(),
        corners_.address(), order_count_,     std::uint32_t(mesh_->triangle_count())};
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
    return {
        {"build_ms", milliseconds, "ms"},
        {"memory_bytes", double(structures::bvh::wide::WideBuilder::tree_bytes(capacity)), "bytes"},
        {"nodes", double(wide_.header().node_count)}};
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
    const QueryStatus status = query_.status();
    Samples samples{{"query_ms", times_.milliseconds("begin", "end"), "ms"},
                    {"incomplete", double(status.incomplete)},
                    {"deferred_points", double(status.deferred_points)}};
    if (config_.statistics) {
        double nodes = 0, triangles = 0;
        std::uint32_t most = 0;
        for (const PointCost& cost : query_.costs()) {
            nodes += cost.nodes;
            triangles += cost.triangles;
            most = std::max(most, cost.nodes);
        }
        const double count = std::max(points.valid_count(), 1u);
        samples.push_back({"visited_nodes_mean", nodes / count});
        samples.push_back({"visited_nodes_max", double(most)});
        samples.push_back({"tested_triangles_mean", triangles / count});
        samples.push_back({"exact_tests_mean", status.exact_tests / count});
        samples.push_back({"groups", double(status.groups)});
    }
    return samples;
}

std::vector<float> BvhMethod::heat() {
    std::vector<float> nodes;
    for (const PointCost& cost : query_.costs()) nodes.push_back(float(cost.nodes));
    return nodes;
}

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"bvh", "any-hit in an 8-wide BVH on the GPU, exact leaf test", &parameters, &create},
    };
    return all;
}

}  // namespace shadows::bvh
