// The irregular z-buffer where it is special: crowded cells, full lists, what it counts and
// refuses. That it is exact is tested together with all methods that are: exact_methods_test.cpp.
#include "shadows/izb/query.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <list>
#include <random>

#include "tests/shadows/exact_scenes.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/points.hpp"

namespace {

using namespace shadows;
using shadows::izb::Query;
using shadows::izb::QueryConfig;
using shadows::izb::QueryResult;
using structures::geometry::Light;
using tests::differences;
using tests::ExactScene;
using tests::soup;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

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

Answer run(const ExactScene& scene, const QueryConfig& config = {}) {
    Query& query = query_with(config);
    query.prepare(scene.mesh);
    query.set_light(scene.light);
    const Points points(tests::device(), scene.points, scene.width, scene.height);
    Answer answer;
    answer.result = query.run(points, answer.visible);
    return answer;
}

using IzbShadow = tests::GpuTest;

TEST_F(IzbShadow, CrowdedCells) {
    // Most points in very few cells, one of them far off to widen the grid.
    std::mt19937 random(37);
    std::uniform_real_distribution<float> unit(-1, 1);
    ExactScene scene = soup(37, {.triangles = 200, .size = 0.03f, .width = 160, .height = 128});
    scene.light.vector = {0.5f, 2, 0.5f};
    const std::size_t last = scene.points.x.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const float x = unit(random), z = unit(random);
        tests::set_point(scene.points, i, {0.5f + 0.01f * x, 0, 0.5f + 0.01f * z});
    }
    tests::set_point(scene.points, last, {-15, -20, 15});
    tests::add_triangle(scene.mesh, {0.495f, 0.5f, 0}, {0.505f, 0.5f, 0}, {0.5f, 0.5f, 1});
    const std::vector<bool> expected = tests::brute_force(scene);
    const Answer answer = run(scene, {.resolution = 16});
    EXPECT_EQ(differences(answer.visible, expected), 0u);
    EXPECT_GT(answer.result.ranges, 0u);
}

TEST_F(IzbShadow, FullListsLoseNothing) {
    const ExactScene scene = soup(41, {300, 0.75f, 64, 48});
    const std::vector<bool> expected = tests::brute_force(scene);
    const Answer roomy = run(scene, {.resolution = 2048, .entries = 4'000'000});
    const Answer tight = run(scene, {.resolution = 2048, .entries = 1});
    EXPECT_EQ(roomy.result.passes, 1u);
    EXPECT_GT(tight.result.passes, 1u);
    EXPECT_EQ(tight.result.entries, roomy.result.entries);
    EXPECT_EQ(differences(roomy.visible, expected), 0u);
    EXPECT_EQ(differences(tight.visible, expected), 0u);
}

TEST_F(IzbShadow, WhatDoublePrecisionCannotTell) {
    // More pairs than their list has room for.
    const ExactScene flat = tests::in_one_plane(300);
    const std::vector<bool> nothing = tests::brute_force(flat);
    for (std::uint32_t resolution : {0u, 1u}) {
        const Answer answer = run(flat, {.resolution = resolution});
        EXPECT_EQ(differences(answer.visible, nothing), 0u);
        EXPECT_GT(answer.result.unsure, flat.points.x.size());
        EXPECT_GT(answer.result.passes, 1u);
    }
    const ExactScene edges = tests::behind_middles_of_edges();
    const Answer answer = run(edges);
    EXPECT_EQ(differences(answer.visible, tests::brute_force(edges)), 0u);
    EXPECT_GT(answer.result.unsure, 0u);
}

TEST_F(IzbShadow, PointsWhosePlaceOverflowsAreCounted) {
    ExactScene scene = soup(47, {});
    scene.light.vector = {-2e38f, 0, 0};
    for (std::uint32_t i : {3u, 500u, 999u}) tests::set_point(scene.points, i, {3e38f, 0, 0});
    tests::set_point(scene.points, 4, {kNan, 0, 0});
    const std::vector<bool> expected = tests::brute_force(scene);
    const Answer far = run(scene);
    EXPECT_EQ(far.result.incomplete, 4u);
    EXPECT_LE(differences(far.visible, expected), 4u);
    EXPECT_EQ(run(tests::directional(scene, {0, 1, 0})).result.incomplete, 4u);
    // A point at the light has its answer.
    scene = soup(48, {});
    tests::set_point(scene.points, 7, scene.light.vector);
    EXPECT_EQ(run(scene).result.incomplete, 0u);
}

TEST_F(IzbShadow, StatisticsCountWork) {
    const ExactScene scene = soup(43, {500, 0.15f, 64, 48});
    const Answer plain = run(scene), counted = run(scene, {.statistics = true});
    EXPECT_EQ(plain.visible.words, counted.visible.words);
    EXPECT_EQ(plain.result.tests, 0u);
    EXPECT_GT(counted.result.tests, 0u);
    EXPECT_LE(counted.result.exact_tests, counted.result.tests);
}

TEST_F(IzbShadow, RefusesLightsThatAreNone) {
    Query query(tests::device(), {});
    query.prepare(soup(1, {1}).mesh);
    EXPECT_THROW(query.set_light({Light::Type::point, {kNan, 0, 0}}), std::invalid_argument);
    EXPECT_THROW(query.set_light({Light::Type::point, {0, kInf, 0}}), std::invalid_argument);
    EXPECT_THROW(query.set_light({Light::Type::directional, {0, 0, 0}}), std::invalid_argument);
}

}  // namespace
