// The BVH shadow query under tight limits, and what it counts. That it is exact is tested together
// with all methods that are: exact_methods_test.cpp.
#include "shadows/bvh/query.hpp"

#include <gtest/gtest.h>

#include "structures/bvh/reference.hpp"
#include "tests/shadows/exact_scenes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace shadows;
using shadows::bvh::Query;
using shadows::bvh::QueryConfig;
using shadows::bvh::QueryKind;
using shadows::tiles::Limits;
using shadows::tiles::QueryStatus;
using tests::ExactScene;

constexpr QueryKind kKinds[] = {QueryKind::lane, QueryKind::packet, QueryKind::beam};

struct Result {
    Visibility visible;
    QueryStatus status;
    std::vector<shadows::tiles::PointCost> costs;
};

Result run(const ExactScene& scene, const QueryConfig& config) {
    taskpool::gpu::Device& device = tests::device();
    const structures::bvh::Tree tree = structures::bvh::build_reference(scene.mesh, {});
    using taskpool::gpu::make_buffer;
    const auto nodes = make_buffer<structures::bvh::BvhNode>(device, tree.nodes, "nodes");
    const auto order = make_buffer<std::uint32_t>(device, tree.order, "order");
    const auto positions = make_buffer<glm::vec3>(device, scene.mesh.positions, "positions");
    const auto corners = make_buffer<glm::uvec3>(device, scene.mesh.triangles, "corners");
    const auto order_count = static_cast<std::uint32_t>(tree.order.size());
    structures::bvh::wide::WideBuilder wide(device);
    wide.prepare({order_count, static_cast<std::uint32_t>(tree.nodes.size())});
    const Points points(device, scene.points, scene.width, scene.height);
    Query query(device, config);
    query.prepare(points.count());
    taskpool::gpu::Recorder recorder(device);
    wide.record(recorder, {nodes.address(), order.address(), positions.address(), corners.address(),
                           order_count, static_cast<std::uint32_t>(scene.mesh.triangle_count())});
    query.record(recorder, wide.tree(), points.address(), points.count(), scene.light);
    device.run(recorder);
    EXPECT_EQ(wide.pending(), 0u);
    return {query.visibility(), query.status(), query.costs()};
}

/// All kinds equal brute force.
void check(const ExactScene& scene, const std::vector<bool>& expected, const Limits& limits) {
    for (QueryKind kind : kKinds) {
        const Result result = run(scene, {.kind = kind, .limits = limits});
        EXPECT_EQ(tests::differences(result.visible, expected), 0u) << "query kind " << int(kind);
        EXPECT_EQ(result.status.incomplete, 0u);
    }
}

using BvhShadow = tests::GpuTest;

TEST_F(BvhShadow, TinyLimitsLoseNothing) {
    const ExactScene scene = tests::soup(29, {3000, 0.1f});
    const std::vector<bool> expected = tests::brute_force(scene);
    for (const Limits& limits : {Limits{.stack = 1}, Limits{.scratch = 64}, Limits{.steps = 5},
                                 Limits{.density = 0}, Limits{.stack = 1, .density = 1000}})
        check(scene, expected, limits);
    EXPECT_GT(run(scene, {.limits = {.stack = 1}}).status.stack_full, 0u);
    EXPECT_GT(run(scene, {.limits = {.steps = 5}}).status.step_limit, 0u);
    EXPECT_GT(run(scene, {.limits = {.steps = 5}}).status.deferred_points, 0u);
    // A beam that meets too many triangles gives way to packets, and to packets alone.
    EXPECT_GT(run(scene, {.limits = {.density = 0}}).status.packet_tiles, 0u);
    EXPECT_EQ(run(scene, {.limits = {.density = 0}}).status.deferred_points, 0u);
    EXPECT_EQ(run(scene, {.limits = {.density = 100'000}}).status.packet_tiles, 0u);
    // The per-point walk has nobody behind it: it must say that it failed.
    EXPECT_GT(run(scene, {.kind = QueryKind::lane, .limits = {.point_steps = 2}}).status.incomplete,
              0u);
}

TEST_F(BvhShadow, StatisticsCountWork) {
    const ExactScene scene = tests::soup(37, {500, 0.2f});
    for (QueryKind kind : kKinds) {
        const Result plain = run(scene, {.kind = kind});
        const Result counted = run(scene, {.kind = kind, .limits = {.statistics = true}});
        EXPECT_EQ(plain.visible.words, counted.visible.words);
        EXPECT_TRUE(plain.costs.empty());
        ASSERT_EQ(counted.costs.size(), scene.points.x.size());
        std::uint64_t nodes = 0;
        for (const shadows::tiles::PointCost& cost : counted.costs) nodes += cost.nodes;
        EXPECT_GT(nodes, 0u);
    }
}

}  // namespace
