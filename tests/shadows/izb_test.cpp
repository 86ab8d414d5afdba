// The irregular z-buffer: bit for bit the answers of single rays through a BVH and of every
// triangle tried in turn, both by the same exact test, whatever the input, the grid and the room in
// lists.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <list>
#include <random>

#include "experiments/gbuffer/gbuffer.hpp"
#include "experiments/scenes/generators.hpp"
#include "shadows/izb/query.hpp"
#include "shadows/method.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/occlusion.hpp"

namespace {

using namespace shadows;
using shadows::izb::Query;
using shadows::izb::QueryConfig;
using shadows::izb::QueryResult;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using tests::add_box;
using tests::add_triangle;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Scene {
    TriangleMesh mesh;
    Light light;
    PointArrays points;
    std::uint32_t width = 0, height = 0;
};

std::uint32_t new_seed() {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    return seed;
}

struct Random {
    std::mt19937 engine;
    explicit Random(std::uint32_t seed) : engine(seed) {}
    float unit() { return std::uniform_real_distribution<float>(0, 1)(engine); }
    glm::vec3 in_cube() { return {unit() * 2 - 1, unit() * 2 - 1, unit() * 2 - 1}; }
};

/// Room for `count` points, none of which there is yet.
void no_points(Scene& scene, std::uint32_t count) {
    scene.width = 64;
    scene.height = (count + 63) / 64;
    const std::size_t padded = ((scene.height + 15) / 16) * 4 * kTilePoints;
    for (std::vector<float>* plane : {&scene.points.x, &scene.points.y, &scene.points.z})
        plane->assign(padded, 0);
    scene.points.primitive.assign(padded, kNoPrimitive);
    scene.points.normal.assign(padded, glm::vec3(0, 0, 1));
}

void set_point(Scene& scene, std::uint32_t i, glm::vec3 p, std::uint32_t primitive = kNoReceiver) {
    scene.points.x[i] = p.x;
    scene.points.y[i] = p.y;
    scene.points.z[i] = p.z;
    scene.points.primitive[i] = primitive;
}

/// A point of triangle t.
glm::vec3 on_triangle(const TriangleMesh& mesh, std::uint32_t t, Random& random) {
    glm::vec3 w(random.unit() + 1e-3f, random.unit() + 1e-3f, random.unit() + 1e-3f);
    w /= w.x + w.y + w.z;
    return w.x * mesh.corner(t, 0) + w.y * mesh.corner(t, 1) + w.z * mesh.corner(t, 2);
}

/// Points on the mesh's triangles and in the cube of side `size` around `centre`, by halves.
void scatter_points(Scene& scene, std::uint32_t count, Random& random, float size = 2,
                    glm::vec3 centre = {}) {
    no_points(scene, count);
    const auto triangles = static_cast<std::uint32_t>(scene.mesh.triangle_count());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (triangles > 0 && i % 2 == 0) {
            const std::uint32_t t = random.engine() % triangles;
            set_point(scene, i, on_triangle(scene.mesh, t, random), t);
        } else {
            set_point(scene, i, centre + random.in_cube() * (size / 2));
        }
    }
}

/// Triangles of size `size` in the cube [-1, 1]^3, all scaled and moved.
Scene soup(std::uint32_t seed, std::uint32_t triangles, float size, std::uint32_t points,
           float scale = 1, glm::vec3 offset = {}) {
    Random random(seed);
    Scene scene;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const glm::vec3 at = random.in_cube();
        const auto corner = [&] { return (at + 0.5f * size * random.in_cube()) * scale + offset; };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        add_triangle(scene.mesh, a, b, c);
    }
    scatter_points(scene, points, random, 2 * scale, offset);
    scene.light.vector = random.in_cube() * scale + offset;
    return scene;
}

Scene directional(Scene scene, glm::vec3 direction) {
    scene.light = {Light::Type::directional, direction};
    return scene;
}

struct Answer {
    Visibility visible;
    QueryResult result;
};

/// The query of that configuration; kept, since making one compiles its kernels.
Query& query_with(const QueryConfig& config) {
    taskpool::gpu::Device& device = tests::device();  // before the list, to outlive it
    static std::list<std::pair<QueryConfig, Query>> queries;
    for (auto& [known, query] : queries)
        if (known == config) return query;
    return queries
        .emplace_back(std::piecewise_construct, std::forward_as_tuple(config),
                      std::forward_as_tuple(device, config))
        .second;
}

Answer run(const Scene& scene, const QueryConfig& config = {}) {
    Query& query = query_with(config);
    query.prepare(scene.mesh);
    query.set_light(scene.light);
    const Points points(tests::device(), scene.points, scene.width, scene.height);
    Answer answer;
    answer.result = query.run(points, answer.visible);
    return answer;
}

/// Every triangle tried in turn.
std::vector<bool> brute_force(const Scene& scene) {
    std::vector<bool> lit(scene.points.x.size(), true);
    for (std::size_t i = 0; i < lit.size(); ++i)
        if (scene.points.primitive[i] != kNoPrimitive)
            lit[i] = !tests::occluded({scene.points.x[i], scene.points.y[i], scene.points.z[i]},
                                      scene.points.primitive[i], scene.light, scene.mesh);
    return lit;
}

std::size_t differences(const Visibility& visible, const std::vector<bool>& expected) {
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < expected.size(); ++i) wrong += visible.lit(i) != expected[i];
    return wrong;
}

void check(const Scene& scene) {
    const std::vector<bool> expected = brute_force(scene);
    for (std::uint32_t resolution : {0u, 1u, 8u, 64u, 512u})
        EXPECT_EQ(differences(run(scene, {.resolution = resolution}).visible, expected), 0u)
            << "resolution " << resolution;
}

/// `name` with `settings`, from the registry.
Visibility ask(const std::string& name, const std::map<std::string, structures::Value>& settings,
               const TriangleMesh& mesh, const Light& light, const Points& points) {
    for (const MethodRow& row : registry()) {
        if (row.name != name) continue;
        const auto method =
            row.create(tests::device(), structures::Settings::resolve(row.parameters(), settings));
        EXPECT_TRUE(method->claims_exact());
        method->prepare(mesh);
        method->build(light);
        Visibility visible;
        method->query(points, visible);
        return visible;
    }
    throw std::runtime_error("no method " + name);
}

using IzbShadow = tests::GpuTest;

TEST_F(IzbShadow, RandomSoupsOfManySizes) {
    const std::uint32_t seed = new_seed();
    std::uint32_t round = 0;
    for (std::uint32_t triangles : {1u, 2u, 7u, 8u, 9u, 60u, 700u})
        for (float size : {0.01f, 0.3f, 3.0f}) {
            SCOPED_TRACE(testing::Message() << triangles << " triangles of " << size);
            const Scene scene = soup(seed + round++, triangles, size, 1500);
            check(scene);
            check(directional(scene, Random(seed + round).in_cube()));
        }
}

TEST_F(IzbShadow, AnyNumberOfPoints) {
    for (std::uint32_t points : {0u, 1u, 7u, 8u, 9u, 255u, 256u, 257u, 5000u}) {
        SCOPED_TRACE(points);
        check(soup(points + 1, 50, 0.5f, points));
        check(directional(soup(points + 2, 50, 0.5f, points), {0.2f, -1, 0.1f}));
    }
}

TEST_F(IzbShadow, NoTrianglesNoShadow) {
    const Scene scene = soup(3, 0, 1, 300);
    check(scene);
    check(directional(scene, {0, -1, 0}));
}

TEST_F(IzbShadow, EqualsSingleRaysOnGeneratedScenes) {
    for (const auto& row : experiments::scenes::generators()) {
        if (row.name == "hairball") continue;
        SCOPED_TRACE(row.name);
        const auto scene = row.generate(
            structures::Settings::resolve(row.parameters(), {{"triangles", std::int64_t{20'000}}}));
        const auto seen = experiments::gbuffer::render_gbuffer(tests::device(), scene.mesh,
                                                               scene.camera, 400, 300);
        for (const Light& light : {scene.light, Light{Light::Type::directional, {1, -2, 0.5f}}}) {
            const Visibility expected =
                ask("bvh", {{"query", "lane"}}, scene.mesh, light, seen.points);
            for (std::int64_t resolution : {0, 16, 128, 1024})
                EXPECT_EQ(
                    ask("izb", {{"resolution", resolution}}, scene.mesh, light, seen.points).words,
                    expected.words)
                    << "resolution " << resolution;
        }
    }
}

TEST_F(IzbShadow, LightInAClosedRoom) {
    Random random(new_seed());
    Scene scene;
    add_box(scene.mesh, {-2, -1, -3}, {2, 1, 3});
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 at = random.in_cube() * glm::vec3(1.9f, 0.9f, 2.9f);
        add_box(scene.mesh, at, at + 0.1f * random.unit() + 0.01f);
    }
    scatter_points(scene, 4000, random, 7);
    for (const glm::vec3& at : {glm::vec3(0), glm::vec3(0.3f, -0.2f, 1), glm::vec3(1.99f, 0, 0)}) {
        scene.light.vector = at;
        check(scene);
    }
}

TEST_F(IzbShadow, TrianglesAroundTheLight) {
    Random random(new_seed());
    Scene scene;
    // Large, through the planes between faces and through the plane of each face at the light.
    for (int i = 0; i < 200; ++i)
        add_triangle(scene.mesh, 2.0f * random.in_cube(), 2.0f * random.in_cube(),
                     2.0f * random.in_cube());
    // Small and close to the light.
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 at = 0.02f * random.in_cube();
        add_triangle(scene.mesh, at, at + 0.01f * random.in_cube(), at + 0.01f * random.in_cube());
    }
    scatter_points(scene, 3000, random, 4);
    check(scene);
}

TEST_F(IzbShadow, ThinCables) {
    Random random(new_seed());
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 a(-1, random.unit(), random.unit() * 2 - 1);
        const glm::vec3 b(1, random.unit(), random.unit() * 2 - 1), thick(0, 1e-4f, 1e-4f);
        add_triangle(scene.mesh, a, b, b + thick);
        add_triangle(scene.mesh, a, b + thick, a + thick);
    }
    scatter_points(scene, 3000, random, 2, {0, -1, 0});
    scene.light.vector = {0.1f, 3, 0.2f};
    // Points behind a cable.
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec3 on = on_triangle(scene.mesh, i % 200, random);
        set_point(scene, i, scene.light.vector + 1.5f * (on - scene.light.vector));
    }
    check(scene);
    check(directional(scene, {0, -1, 0}));
}

TEST_F(IzbShadow, LightOnVertexEdgeAndFace) {
    Random random(7);
    Scene scene;
    add_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
    scatter_points(scene, 2000, random, 4);
    for (const glm::vec3& at : {glm::vec3(1, 1, 1), glm::vec3(1, 1, 0), glm::vec3(1, 0.25f, 0)}) {
        scene.light.vector = at;
        check(scene);
    }
}

TEST_F(IzbShadow, PointsAtAndNextToTheLight) {
    Scene scene = soup(new_seed(), 300, 0.5f, 1000);
    for (std::uint32_t i = 0; i < 300; ++i) {
        glm::vec3 p = scene.light.vector;
        if (i % 3 == 1) p[i / 3 % 3] = std::nextafter(p[i / 3 % 3], kInf);
        if (i % 3 == 2) p += std::pow(0.5f, float(i) / 6) * (i % 2 ? 1.0f : -1.0f);
        set_point(scene, i, p);
    }
    check(scene);
    // Around a light at the origin, distances reach down to where floats end.
    scene.light.vector = {};
    for (std::uint32_t i = 0; i < 300; ++i)
        set_point(scene, i, std::ldexp(1.0f, -int(i) / 2) * glm::vec3(1, 0.5f, i % 2 ? 0.25f : -1));
    add_triangle(scene.mesh, {1e-20f, 1e-21f, 1e-20f}, {1e-20f, -1e-20f, 0}, {1e-20f, 0, -1e-20f});
    check(scene);
}

TEST_F(IzbShadow, ScalesAndOffsets) {
    for (float scale : {1e-12f, 1e-4f, 1e4f, 1e12f}) {
        SCOPED_TRACE(scale);
        check(soup(11, 200, 0.5f, 1500, scale));
        check(directional(soup(12, 200, 0.5f, 1500, scale), {1, -2, 0.5f}));
    }
    const glm::vec3 far(1 << 20, 1 << 20, 1 << 20);
    check(soup(13, 200, 0.5f, 1500, 16, far));
    check(directional(soup(13, 200, 0.5f, 1500, 16, far), {1, -2, 0.5f}));
}

TEST_F(IzbShadow, FarLights) {
    Scene scene = soup(17, 200, 0.3f, 1500);
    for (float distance : {1e3f, 1e6f, 1e30f}) {
        scene.light.vector = glm::vec3(0.3f, 1, -0.2f) * distance;
        check(scene);
    }
}

TEST_F(IzbShadow, DirectionalAlongAxesAndOfAnyLength) {
    const Scene scene = soup(new_seed(), 300, 0.3f, 1500);
    for (int axis = 0; axis < 3; ++axis)
        for (float length : {1.0f, -1.0f, 1e-20f, 1e20f}) {
            glm::vec3 direction(0);
            direction[axis] = length;
            check(directional(scene, direction));
        }
    check(directional(scene, {1, 1, 1}));
    check(directional(scene, {-1, 1, 0}));
}

TEST_F(IzbShadow, CoplanarReceiversAndOwnTriangle) {
    Scene scene;
    for (int i = 0; i < 8; ++i) add_triangle(scene.mesh, {i, 0, 0}, {i + 1, 0, 0}, {i, 0, 1});
    no_points(scene, 1024);
    for (std::uint32_t i = 0; i < 1024; ++i)
        set_point(scene, i, {(i % 32) / 4.0f, 0, (i / 32) / 32.0f}, i % 32 / 4);
    for (const glm::vec3& at : {glm::vec3(3, 2, 0.2f), glm::vec3(3, 0, 5), glm::vec3(4, -1, 0)}) {
        scene.light = {Light::Type::point, at};
        check(scene);
    }
    check(directional(scene, {1, 0, 0}));
    check(directional(scene, {1, -1, 0}));
}

TEST_F(IzbShadow, DegenerateAndInfiniteTrianglesCastNothing) {
    Scene scene = soup(new_seed(), 100, 0.5f, 1500);
    const glm::vec3 p(0.1f, 0.2f, 0.3f), q(0.5f, -0.5f, 0.5f);
    add_triangle(scene.mesh, p, p, q);
    add_triangle(scene.mesh, p, p, p);
    add_triangle(scene.mesh, p, q, p + 2.0f * (q - p));
    for (float bad : {kInf, -kInf, kNan}) {
        add_triangle(scene.mesh, p, q, {bad, 0, 0});
        add_triangle(scene.mesh, {0, bad, bad}, q, {0, 0, 1});
    }
    check(scene);
    check(directional(scene, {0.2f, -1, 0.4f}));
}

TEST_F(IzbShadow, ManyEqualTriangles) {
    Scene one = soup(31, 1, 3, 300);
    for (std::uint32_t& primitive : one.points.primitive)
        if (primitive == 0) primitive = kNoReceiver;
    const std::vector<bool> expected = brute_force(one);
    Scene many = one;
    many.mesh.triangles.assign(100'000, one.mesh.triangles[0]);
    for (std::uint32_t resolution : {0u, 512u})
        EXPECT_EQ(differences(run(many, {.resolution = resolution}).visible, expected), 0u);
}

TEST_F(IzbShadow, CrowdedCells) {
    // Most points in very few cells, one of them far off to widen the grid.
    Random random(37);
    Scene scene = soup(37, 200, 0.05f, 20'000);
    scene.light.vector = {0, 3, 0};
    for (std::uint32_t i = 0; i + 1 < 20'000; ++i)
        set_point(scene, i, 0.02f * random.in_cube() + glm::vec3(0, -1, 0));
    set_point(scene, 19'999, {-30, -40, 30});
    add_triangle(scene.mesh, {-0.01f, 0, -1}, {0.01f, 0, -1}, {0, 0, 1});
    const std::vector<bool> expected = brute_force(scene);
    const Answer answer = run(scene, {.resolution = 16});
    EXPECT_EQ(differences(answer.visible, expected), 0u);
    EXPECT_GT(answer.result.ranges, 0u);
}

TEST_F(IzbShadow, PointsOnALineAndInOnePlace) {
    for (const glm::vec3& across : {glm::vec3(1, 0, 0), glm::vec3(0, 1e-7f, 1), glm::vec3(0)}) {
        Scene scene = soup(new_seed(), 300, 0.5f, 3000);
        for (std::uint32_t i = 0; i < 3000; ++i)
            set_point(scene, i, glm::vec3(0, -0.5f, 0.25f) + across * (i / 1500.0f - 1));
        scene.light.vector = {0, 0.7f, 0.25f};
        check(scene);
        check(directional(scene, {0, -1, 0}));
        check(directional(scene, {0.1f, -1, 0.7f}));
    }
}

TEST_F(IzbShadow, FullListsLoseNothing) {
    const Scene scene = soup(41, 300, 1.5f, 3000);
    const std::vector<bool> expected = brute_force(scene);
    const Answer roomy = run(scene, {.resolution = 2048, .entries = 4'000'000});
    const Answer tight = run(scene, {.resolution = 2048, .entries = 1});
    EXPECT_EQ(roomy.result.passes, 1u);
    EXPECT_GT(tight.result.passes, 1u);
    EXPECT_EQ(tight.result.entries, roomy.result.entries);
    EXPECT_EQ(differences(roomy.visible, expected), 0u);
    EXPECT_EQ(differences(tight.visible, expected), 0u);
}

TEST_F(IzbShadow, WhatDoublePrecisionCannotTell) {
    // The light and all points in the plane of all triangles, which is parallel to no axis: exact
    // zeros, which double precision takes for doubts. More pairs than their list has room for.
    Random random(new_seed());
    const auto whole = [&](float size) { return std::round(size * (2 * random.unit() - 1)); };
    const auto in_plane = [&] {
        return whole(500) * glm::vec3(1, 2, 4) + whole(500) * glm::vec3(3, -1, 5);
    };
    Scene flat;
    for (int i = 0; i < 300; ++i) add_triangle(flat.mesh, in_plane(), in_plane(), in_plane());
    no_points(flat, 2000);
    for (std::uint32_t i = 0; i < 2000; ++i) set_point(flat, i, in_plane());
    flat.light.vector = in_plane();
    const std::vector<bool> nothing = brute_force(flat);
    for (std::uint32_t resolution : {0u, 1u}) {
        const Answer answer = run(flat, {.resolution = resolution});
        EXPECT_EQ(differences(answer.visible, nothing), 0u);
        EXPECT_GT(answer.result.unsure, flat.points.x.size());
        EXPECT_GT(answer.result.passes, 1u);
    }
    // Segments through the middle of an edge, which belongs to the triangle.
    Scene edges;
    const auto even = [&] { return 2.0f * glm::vec3(whole(50), whole(50), whole(50)); };
    edges.light.vector = even();
    no_points(edges, 1000);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec3 a = even(), b = even(), c = even();
        if (i % 50 == 0) add_triangle(edges.mesh, a, b, c);
        const std::size_t t = edges.mesh.triangle_count() - 1;
        const int k = int(i % 3);
        const glm::vec3 middle =
            0.5f * (edges.mesh.corner(t, k) + edges.mesh.corner(t, (k + 1) % 3));
        set_point(edges, i, middle + float(1 + i % 5) * (middle - edges.light.vector));
    }
    const std::vector<bool> expected = brute_force(edges);
    const Answer answer = run(edges);
    EXPECT_EQ(differences(answer.visible, expected), 0u);
    EXPECT_GT(answer.result.unsure, 0u);
}

TEST_F(IzbShadow, PointsWhosePlaceOverflowsAreCounted) {
    Scene scene = soup(47, 100, 0.5f, 1000);
    scene.light.vector = {-2e38f, 0, 0};
    for (std::uint32_t i : {3u, 500u, 999u}) set_point(scene, i, {3e38f, 0, 0});
    set_point(scene, 4, {kNan, 0, 0});
    const std::vector<bool> expected = brute_force(scene);
    const Answer far = run(scene);
    EXPECT_EQ(far.result.incomplete, 4u);
    EXPECT_LE(differences(far.visible, expected), 4u);
    EXPECT_EQ(run(directional(scene, {0, 1, 0})).result.incomplete, 4u);
    // A point at the light has its answer.
    scene = soup(48, 100, 0.5f, 1000);
    set_point(scene, 7, scene.light.vector);
    EXPECT_EQ(run(scene).result.incomplete, 0u);
}

TEST_F(IzbShadow, StatisticsCountWork) {
    const Scene scene = soup(43, 500, 0.3f, 3000);
    const Answer plain = run(scene), counted = run(scene, {.statistics = true});
    EXPECT_EQ(plain.visible.words, counted.visible.words);
    EXPECT_EQ(plain.result.tests, 0u);
    EXPECT_GT(counted.result.tests, 0u);
    EXPECT_LE(counted.result.exact_tests, counted.result.tests);
}

TEST_F(IzbShadow, RefusesLightsThatAreNone) {
    Query query(tests::device(), {});
    query.prepare(soup(1, 1, 1, 1).mesh);
    EXPECT_THROW(query.set_light({Light::Type::point, {kNan, 0, 0}}), std::invalid_argument);
    EXPECT_THROW(query.set_light({Light::Type::point, {0, kInf, 0}}), std::invalid_argument);
    EXPECT_THROW(query.set_light({Light::Type::directional, {0, 0, 0}}), std::invalid_argument);
}

}  // namespace
