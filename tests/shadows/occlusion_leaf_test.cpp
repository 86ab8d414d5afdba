// The leaf test on the device: the exact one has the bits of exact arithmetic where single and
// double precision fail, and the shortcuts fail where they are expected to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include "shadows/method.hpp"
#include "structures/parameters.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/occlusion.hpp"
#include "tests/support/points.hpp"

namespace {

using namespace shadows;
using structures::Sample;
using structures::Settings;
using structures::Value;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using tests::add_triangle;

using Given = std::map<std::string, Value>;

struct Scene {
    TriangleMesh mesh;
    Light light;
    std::vector<glm::vec3> points;  ///< on no triangle
};

std::unique_ptr<Method> method(const Given& given) {
    for (const MethodRow& row : registry())
        if (row.name == "bvh")
            return row.create(tests::device(), Settings::resolve(row.parameters(), given));
    throw std::logic_error("no method bvh");
}

struct Result {
    std::vector<bool> lit;
    structures::Samples samples;
    double operator[](std::string_view metric) const {
        for (const Sample& sample : samples)
            if (sample.metric == metric) return sample.value;
        throw std::logic_error("no sample " + std::string(metric));
    }
    std::size_t count() const { return std::size_t(std::count(lit.begin(), lit.end(), true)); }
};

Result run(const Scene& scene, Given given) {
    given["statistics"] = true;
    const auto height =
        static_cast<std::uint32_t>((scene.points.size() + kTileSide - 1) / kTileSide);
    const Points points(tests::device(), tests::free_points(scene.points, kTileSide, height),
                        kTileSide, height);
    const std::unique_ptr<Method> bvh = method(given);
    bvh->prepare(scene.mesh);
    bvh->build(scene.light);
    Visibility visible;
    Result result;
    result.samples = bvh->query(points, visible);
    for (std::size_t i = 0; i < scene.points.size(); ++i)
        result.lit.push_back(visible.lit(static_cast<std::uint32_t>(i)));
    EXPECT_EQ(result["incomplete"], 0);
    return result;
}

/// Every kind of query against exact arithmetic, every point against every triangle; returns the
/// result of single segments.
Result check(const Scene& scene) {
    Result last;
    for (const char* query : {"beam", "packet", "lane"}) {
        last = run(scene, {{"query", std::string(query)}});
        std::size_t wrong = 0, first = 0;
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            const bool lit =
                !tests::occluded(scene.points[i], kNoReceiver, scene.light, scene.mesh);
            if (lit == last.lit[i]) continue;
            if (wrong++ == 0) first = i;
        }
        const glm::vec3 p = scene.points[first];
        EXPECT_EQ(wrong, 0u) << query << ", first point " << first << ": " << p.x << ' ' << p.y
                             << ' ' << p.z;
    }
    return last;
}

using OcclusionLeaf = tests::GpuTest;

// Nearly every sign that is not clear is exactly 0: coplanar segments, lights on corners, edges and
// faces, segments through edges.
TEST_F(OcclusionLeaf, SmallIntegers) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    const auto lattice = [&](float scale) {
        const auto one = [&] {
            return scale * float(std::uniform_int_distribution(-4, 4)(random));
        };
        const float x = one(), y = one();
        return glm::vec3(x, y, one());
    };
    double exact_decisions = 0;
    for (int round = 0; round < 4; ++round) {
        Scene scene;
        for (int i = 0; i < 60; ++i) {
            const glm::vec3 a = lattice(1), b = lattice(1), c = lattice(1);
            add_triangle(scene.mesh, a, b, c);
        }
        scene.light = {round % 2 ? Light::Type::directional : Light::Type::point,
                       round % 2 ? lattice(1) + glm::vec3(0, 0, 9) : scene.mesh.positions[7]};
        for (int i = 0; i < 512; ++i) scene.points.push_back(lattice(0.5f));
        const Result result = check(scene);
        EXPECT_GT(result["fp64_decisions"], 0);
        EXPECT_GE(result["fp64_decisions"], result["exact_decisions"]);
        exact_decisions += result["exact_decisions"];
    }
    EXPECT_GT(exact_decisions, 0);
}

// A light on a corner that is no dyadic fraction lies exactly in its triangles' planes, which no
// sum of rounded products shows; with coordinates of all sizes the sums need many parts.
TEST_F(OcclusionLeaf, LightOnACorner) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int range : {0, 12, 40}) {
        SCOPED_TRACE(range);
        std::uniform_int_distribution<int> exponent(-range, range);
        const auto number = [&] { return std::ldexp(unit(random), exponent(random)); };
        const auto vector = [&] {
            const float x = number(), y = number();
            return glm::vec3(x, y, number());
        };
        Scene scene;
        const glm::vec3 corner = vector();
        scene.light = {Light::Type::point, corner};
        for (int i = 0; i < 24; ++i) {
            const glm::vec3 a = vector(), b = vector();
            add_triangle(scene.mesh, a, i % 2 ? corner : b, i % 2 ? b : corner);
        }
        for (int i = 0; i < 256; ++i) scene.points.push_back(vector());
        const Result result = check(scene);
        EXPECT_EQ(result.count(), scene.points.size());
        EXPECT_GT(result["exact_decisions"], 0);
    }
}

TEST_F(OcclusionLeaf, ScalesBeyondSinglePrecision) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (float scale : {1e-20f, 1e-15f, 1e15f}) {
        SCOPED_TRACE(scale);
        const auto vector = [&] {
            const float x = unit(random), y = unit(random);
            return scale * glm::vec3(x, y, unit(random));
        };
        Scene scene;
        for (int i = 0; i < 100; ++i) {
            const glm::vec3 a = vector(), b = vector();
            add_triangle(scene.mesh, a, b, vector());
        }
        for (int i = 0; i < 256; ++i) scene.points.push_back(vector());
        scene.light = {Light::Type::point, vector()};
        check(scene);
    }
}

// Triangles around the origin that are smaller than the rounding of the distance to points and
// light, which lie in line with them as well as rounding allows.
TEST_F(OcclusionLeaf, TrianglesSmallerThanTheirRounding) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] {
        const float x = unit(random), y = unit(random);
        return glm::vec3(x, y, unit(random));
    };
    for (int exponent : {-18, -24, -30, -36}) {
        SCOPED_TRACE(exponent);
        Scene scene;
        for (int i = 0; i < 40; ++i) {
            const float size = std::ldexp(1.f, exponent);
            const glm::vec3 a = size * vector(), b = size * vector();
            add_triangle(scene.mesh, a, b, size * vector());
        }
        scene.light = {Light::Type::point, vector() + glm::vec3(0, 2, 0)};
        for (int i = 0; i < 512; ++i) {
            const glm::vec3 on = scene.mesh.positions[i % scene.mesh.positions.size()];
            scene.points.push_back(on + (0.5f + i / 1024.f) * (on - scene.light.vector));
        }
        const Result result = check(scene);
        EXPECT_GT(result["fp64_decisions"], 0);
    }
}

/// Points behind a fan of triangles around a hub, as exactly as rounding allows on the lines from
/// the light through the fan's inner edges: all in shadow.
Scene fan() {
    Scene scene;
    scene.light = {Light::Type::point, {0.3f, 0.1f, -0.2f}};
    const glm::vec3 hub(0.1f, -3, 0.2f);
    constexpr int kSpokes = 64;
    std::vector<glm::vec3> rim;
    for (int i = 0; i < kSpokes; ++i) {
        const float angle = 6.2831853f * float(i) / kSpokes;
        rim.push_back(hub +
                      glm::vec3(std::cos(angle), 0.1f * std::sin(7 * angle), std::sin(angle)));
    }
    for (int i = 0; i < kSpokes; ++i) add_triangle(scene.mesh, hub, rim[i], rim[(i + 1) % kSpokes]);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 0.9f);
    for (int i = 0; i < 16384; ++i) {
        const glm::vec3 on = hub + unit(random) * (rim[i % kSpokes] - hub);
        scene.points.push_back(scene.light.vector +
                               (1.5f + unit(random)) * (on - scene.light.vector));
    }
    return scene;
}

TEST_F(OcclusionLeaf, ShortcutsAtSharedEdges) {
    const Scene scene = fan();
    for (const char* query : {"packet", "lane"}) {
        const auto leaks = [&](const char* leaf, bool contraction = false) {
            const std::size_t lit = run(scene, {{"query", std::string(query)},
                                                {"leaf", std::string(leaf)},
                                                {"contraction", contraction}})
                                        .count();
            std::printf("%s, %s%s: %zu leaks of %zu\n", query, leaf,
                        contraction ? ", contracted" : "", lit, scene.points.size());
            return lit;
        };
        EXPECT_EQ(leaks("exact"), 0u);
        EXPECT_EQ(leaks("watertight"), 0u);
        EXPECT_GT(leaks("watertight", true), 0u);
        EXPECT_GT(leaks("moeller_trumbore"), 0u);
        leaks("double");
    }
    EXPECT_EQ(run(scene, {}).count(), 0u);
}

// Far from edges and planes all tests agree, on every kind of light.
TEST_F(OcclusionLeaf, ShortcutsAgreeOnOrdinaryTriangles) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] {
        const float x = unit(random), y = unit(random);
        return glm::vec3(x, y, unit(random));
    };
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 at = vector(), a = vector(), b = vector();
        add_triangle(scene.mesh, at, at + 0.3f * a, at + 0.3f * b);
    }
    for (int i = 0; i < 4096; ++i) scene.points.push_back(vector());
    for (Light::Type type : {Light::Type::point, Light::Type::directional}) {
        scene.light = {type, vector()};
        const Result exact = run(scene, {{"query", std::string("lane")}});
        EXPECT_GT(exact.count(), 0u);
        EXPECT_LT(exact.count(), scene.points.size());
        for (const char* leaf : {"watertight", "moeller_trumbore", "double"}) {
            const Result other =
                run(scene, {{"query", std::string("lane")}, {"leaf", std::string(leaf)}});
            std::size_t differing = 0;
            for (std::size_t i = 0; i < exact.lit.size(); ++i)
                differing += exact.lit[i] != other.lit[i];
            EXPECT_LE(differing, 2u) << leaf;
        }
    }
}

// Points on the floor under a low shelf: a bias longer than the shelf is high steps over it.
TEST_F(OcclusionLeaf, BiasLosesContactShadows) {
    Scene scene;
    scene.light = {Light::Type::point, {0, 10, 0}};
    add_triangle(scene.mesh, {-9, 0.01f, -9}, {9, 0.01f, -9}, {0, 0.01f, 9});
    for (int i = 0; i < 256; ++i)
        scene.points.emplace_back(0.1f * float(i % 16 - 8), 0, 0.1f * float(i / 16 - 8));
    for (const char* query : {"beam", "lane"}) {
        const auto lit = [&](double bias) {
            return run(scene, {{"query", std::string(query)}, {"bias", bias}}).count();
        };
        EXPECT_EQ(lit(0), 0u);
        EXPECT_EQ(lit(1e-6), 0u);
        EXPECT_EQ(lit(1e-2), scene.points.size());
        // Towards a directional light, a fraction of the scene's diagonal, some 25.
        scene.light = {Light::Type::directional, {0, -3, 0}};
        EXPECT_EQ(lit(1e-6), 0u);
        EXPECT_EQ(lit(1e-3), scene.points.size());
        scene.light = {Light::Type::point, {0, 10, 0}};
    }
}

TEST_F(OcclusionLeaf, OnlyTheExactTestClaimsExactness) {
    EXPECT_TRUE(method({})->claims_exact());
    EXPECT_FALSE(method({{"bias", 1e-6}})->claims_exact());
    const std::string lane = "lane";
    for (const char* leaf : {"watertight", "moeller_trumbore", "double"})
        EXPECT_FALSE(method({{"query", lane}, {"leaf", std::string(leaf)}})->claims_exact());
    EXPECT_THROW(method({{"leaf", std::string("watertight")}}), structures::SettingError);
    EXPECT_THROW(method({{"query", lane}, {"contraction", true}}), structures::SettingError);
}

}  // namespace
