// The BVH shadow query: every kind and every limit gives the bits of the exact test, and that
// agrees with double precision wherever double precision is sure.
#include "shadows/bvh/query.hpp"

#include <gtest/gtest.h>

#include <random>

#include "structures/bvh/reference.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/occlusion.hpp"
#include "tests/support/points.hpp"

namespace {

using namespace shadows;
using shadows::bvh::Query;
using shadows::bvh::QueryConfig;
using shadows::bvh::QueryKind;
using shadows::tiles::Limits;
using shadows::tiles::QueryStatus;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using tests::add_box;
using tests::add_triangle;

constexpr QueryKind kKinds[] = {QueryKind::lane, QueryKind::packet, QueryKind::beam};

struct Scene {
    TriangleMesh mesh;
    Light light;
    PointArrays points;
    std::uint32_t width = 16, height = 16;
};

/// An image without points.
Scene make_scene(std::uint32_t width, std::uint32_t height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.points = tests::no_points(width, height);
    return scene;
}

void set_point(Scene& scene, std::uint32_t x, std::uint32_t y, glm::vec3 p,
               std::uint32_t primitive = kNoReceiver) {
    tests::set_point(scene.points, point_index(x, y, scene.width), p, primitive);
}

struct Result {
    Visibility visible;
    QueryStatus status;
    std::vector<shadows::tiles::PointCost> costs;
};

Result run(const Scene& scene, const QueryConfig& config) {
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

/// What the exact test says, point by point.
std::vector<bool> expected_lit(const Scene& scene) {
    std::vector<bool> lit(scene.points.x.size(), true);
    for (std::size_t i = 0; i < lit.size(); ++i)
        if (scene.points.primitive[i] != kNoPrimitive)
            lit[i] = !tests::occluded(tests::position(scene.points, i), scene.points.primitive[i],
                                      scene.light, scene.mesh);
    return lit;
}

/// All kinds equal the exact test.
void check(const Scene& scene, const Limits& limits = {}) {
    const std::vector<bool> expected = expected_lit(scene);
    for (QueryKind kind : kKinds) {
        const QueryConfig config{.kind = kind, .limits = limits};
        const Result result = run(scene, config);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            wrong += result.visible.lit(static_cast<std::uint32_t>(i)) != expected[i];
        EXPECT_EQ(wrong, 0u) << "query kind " << int(kind) << ", " << expected.size() << " points";
        EXPECT_EQ(result.status.incomplete, 0u);
    }
}

/// Random triangles of size `size` in the unit cube, scaled and moved; points in the cube and on
/// triangles.
Scene soup(std::uint32_t seed, std::size_t triangles, float size, std::uint32_t width,
           std::uint32_t height, float scale = 1, glm::vec3 offset = {}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto anywhere = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Scene scene = make_scene(width, height);
    for (std::size_t t = 0; t < triangles; ++t) {
        const glm::vec3 at = anywhere();
        const auto corner = [&] { return (at + size * (anywhere() - 0.5f)) * scale + offset; };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        add_triangle(scene.mesh, a, b, c);
    }
    const glm::vec3 eye = anywhere();
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (unit(random) < 0.05f) continue;
            if (triangles > 0 && unit(random) < 0.3f) {
                const auto t = static_cast<std::uint32_t>(unit(random) * 0.999f * triangles);
                glm::vec3 w = anywhere() + 1e-3f;
                w /= w.x + w.y + w.z;
                set_point(scene, x, y,
                          w.x * scene.mesh.corner(t, 0) + w.y * scene.mesh.corner(t, 1) +
                              w.z * scene.mesh.corner(t, 2),
                          t);
            } else {
                // Neighbours on a plane, so that beams are of use.
                const glm::vec3 p = glm::vec3(x / float(width), y / float(height), 0.1f) +
                                    0.01f * anywhere() + 0.1f * eye;
                set_point(scene, x, y, p * scale + offset);
            }
        }
    scene.light.vector = anywhere() * scale + offset;
    return scene;
}

Scene directional(Scene scene, glm::vec3 direction) {
    scene.light = {Light::Type::directional, direction};
    return scene;
}

using BvhShadow = tests::GpuTest;

TEST_F(BvhShadow, RandomSoupsOfManySizes) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    for (std::uint32_t round = 0; round < 3; ++round)
        for (std::size_t triangles : {1u, 2u, 9u, 100u, 1000u})
            for (float size : {0.05f, 0.5f}) {
                const Scene scene = soup(seed + round * 100, triangles, size, 48, 32);
                check(scene);
                check(directional(scene, {0.3f, -0.8f, 0.1f + round}));
            }
}

TEST_F(BvhShadow, ImageSizes) {
    const std::pair<std::uint32_t, std::uint32_t> sizes[] = {{1, 1}, {15, 17}, {16, 16}, {333, 77}};
    for (const auto& [width, height] : sizes) check(soup(7, 60, 0.3f, width, height));
}

TEST_F(BvhShadow, NothingShadowsNothing) {
    Scene scene = soup(3, 0, 1, 16, 16);
    check(scene);
    check(directional(scene, {0, -1, 0}));
    Scene no_points = make_scene(16, 16);
    no_points.mesh = soup(3, 50, 1, 16, 16).mesh;
    check(no_points);
}

TEST_F(BvhShadow, ScalesAndOffsets) {
    for (float scale : {1e-12f, 1e-4f, 1e4f, 1e12f}) {
        SCOPED_TRACE(scale);
        check(soup(11, 200, 0.3f, 32, 32, scale));
        check(directional(soup(12, 200, 0.3f, 32, 32, scale), {1, -2, 0.5f}));
    }
    const glm::vec3 far(1 << 20, 1 << 20, 1 << 20);
    check(soup(13, 200, 0.3f, 32, 32, 16, far));
    check(directional(soup(13, 200, 0.3f, 32, 32, 16, far), {1, -2, 0.5f}));
}

TEST_F(BvhShadow, SliversEdgeOnToTheLight) {
    Scene scene = soup(17, 100, 0.2f, 64, 64);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 a(unit(random), unit(random), unit(random));
        const glm::vec3 along = (scene.light.vector - a) * 0.5f;
        add_triangle(scene.mesh, a, a + along + 1e-4f * unit(random),
                     a + 0.5f * along + glm::vec3(1e-6f * unit(random), 0, 1e-5f));
    }
    check(scene);
}

/// Points behind a fan of triangles around `hub`, exactly on the lines from the light through its
/// vertices and along its edges, and their neighbours in floating point.
Scene fan(Light light, glm::vec3 hub, std::uint32_t spokes) {
    Scene scene = make_scene(64, 64);
    scene.light = light;
    std::vector<glm::vec3> rim;
    for (std::uint32_t i = 0; i < spokes; ++i) {
        const float angle = 6.2831853f * i / spokes;
        rim.push_back(hub +
                      glm::vec3(std::cos(angle), 0.25f * std::sin(3 * angle), std::sin(angle)));
    }
    for (std::uint32_t i = 0; i < spokes; ++i)
        add_triangle(scene.mesh, hub, rim[i], rim[(i + 1) % spokes]);
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        const glm::vec3 end = rim[i / 8 % spokes];
        const float t = float(i / 512) / 8;
        const glm::vec3 on = hub + t * (end - hub);
        glm::vec3 p = light.type == Light::Type::point ? light.vector + 2.0f * (on - light.vector)
                                                       : on + 2.0f * light.vector;
        for (int axis = 0; axis < 3; ++axis)
            if (i >> axis & 1) p[axis] = std::nextafter(p[axis], 1e9f);
        set_point(scene, i % 64, i / 64, p);
    }
    return scene;
}

TEST_F(BvhShadow, NoLeakThroughSharedEdgesAndVertices) {
    const Light lights[] = {{Light::Type::point, {0, 0, 0}},
                            {Light::Type::point, {0.3f, 0.1f, -0.2f}},
                            {Light::Type::directional, {0, -1, 0}},
                            {Light::Type::directional, {0.1f, -1, 0.3f}}};
    for (const Light& light : lights) {
        const Scene scene = fan(light, {0.1f, -3, 0.2f}, 64);
        check(scene);
        // Away from the rim, the fan is closed.
        const Result result = run(scene, {});
        for (std::uint32_t i = 0; i < 7 * 512; ++i)
            EXPECT_FALSE(result.visible.lit(point_index(i % 64, i / 64, 64))) << "point " << i;
    }
}

TEST_F(BvhShadow, LightInAClosedRoom) {
    Scene scene = make_scene(32, 32);
    add_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
    for (std::uint32_t i = 0; i < 1024; ++i)
        set_point(scene, i % 32, i / 32,
                  glm::vec3(int(i % 16) - 8, int(i / 16 % 8) - 4, int(i / 128) - 4) * 0.25f);
    check(scene);
    const Result result = run(scene, {});
    for (std::uint32_t i = 0; i < 1024; ++i) {
        const std::uint32_t at = point_index(i % 32, i / 32, 32);
        const glm::vec3 p(scene.points.x[at], scene.points.y[at], scene.points.z[at]);
        const float far = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        // A point on a wall sees the light: its segment ends on the wall.
        EXPECT_EQ(result.visible.lit(at), far <= 1) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST_F(BvhShadow, LightOnVertexEdgeAndFace) {
    for (const glm::vec3& at : {glm::vec3(1, 1, 1), glm::vec3(1, 1, 0), glm::vec3(1, 0.25f, 0)}) {
        Scene scene = soup(23, 0, 1, 32, 32, 4, {-2, -2, -2});
        add_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
        scene.light.vector = at;
        check(scene);
    }
}

TEST_F(BvhShadow, CoplanarReceiversAndOwnTriangle) {
    Scene scene = make_scene(32, 32);
    for (int i = 0; i < 8; ++i) add_triangle(scene.mesh, {i, 0, 0}, {i + 1, 0, 0}, {i, 0, 1});
    for (std::uint32_t i = 0; i < 1024; ++i)
        set_point(scene, i % 32, i / 32, {(i % 32) / 4.0f, 0, (i / 32) / 32.0f}, i % 32 / 4);
    for (const glm::vec3& at : {glm::vec3(3, 2, 0.2f), glm::vec3(3, 0, 5), glm::vec3(4, -1, 0)}) {
        scene.light = {Light::Type::point, at};
        check(scene);
        const Result result = run(scene, {});
        for (std::uint32_t i = 0; i < 1024; ++i)
            EXPECT_TRUE(result.visible.lit(point_index(i % 32, i / 32, 32)));
    }
    check(directional(scene, {1, 0, 0}));
    check(directional(scene, {1, -1, 0}));
}

TEST_F(BvhShadow, TinyLimitsLoseNothing) {
    const Scene scene = soup(29, 3000, 0.1f, 64, 48);
    for (const Limits& limits : {Limits{.stack = 1}, Limits{.scratch = 64}, Limits{.steps = 5},
                                 Limits{.density = 0}, Limits{.stack = 1, .density = 1000}})
        check(scene, limits);
    EXPECT_GT(run(scene, {.limits = {.stack = 1}}).status.stack_full, 0u);
    EXPECT_GT(run(scene, {.limits = {.steps = 5}}).status.step_limit, 0u);
    EXPECT_GT(run(scene, {.limits = {.steps = 5}}).status.deferred_points, 0u);
    // A beam that meets too many triangles gives way to packets, and to packets alone.
    EXPECT_GT(run(scene, {.limits = {.density = 0}}).status.packet_tiles, 0u);
    EXPECT_EQ(run(scene, {.limits = {.density = 0}}).status.deferred_points, 0u);
    EXPECT_EQ(run(scene, {.limits = {.density = 100'000}}).status.packet_tiles, 0u);
    // The per-point walk has nobody behind it: it must say that it failed.
    EXPECT_GT(run(scene, {.kind = QueryKind::lane, .limits = {.point_steps = 2}}).status.incomplete, 0u);
}

TEST_F(BvhShadow, ManyEqualTriangles) {
    Scene scene = soup(31, 1, 0.8f, 32, 32);
    for (int i = 0; i < 20000; ++i)
        add_triangle(scene.mesh, scene.mesh.corner(0, 0), scene.mesh.corner(0, 1),
                     scene.mesh.corner(0, 2));
    Scene one = scene;
    one.mesh.triangles.resize(1);
    for (std::uint32_t& primitive : one.points.primitive)
        if (primitive == 0) primitive = 0xfffffffeu;
    scene.points = one.points;
    const std::vector<bool> expected = expected_lit(one);
    for (QueryKind kind : kKinds) {
        const Result result = run(scene, {.kind = kind});
        for (std::uint32_t i = 0; i < expected.size(); ++i)
            ASSERT_EQ(result.visible.lit(i), expected[i]);
    }
}

TEST_F(BvhShadow, StatisticsCountWork) {
    const Scene scene = soup(37, 500, 0.2f, 48, 48);
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
