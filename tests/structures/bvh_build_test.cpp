// The BVH built on the GPU: valid at every size where things break, as good as the CPU builders,
// and the same whatever the pool's policy, workgroups and budget.
#include "structures/bvh/bvh.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "structures/bvh/fingerprint.hpp"
#include "structures/bvh/quality.hpp"
#include "structures/bvh/reference.hpp"
#include "structures/bvh/validate.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace structures;
using namespace structures::bvh;
using geometry::TriangleMesh;
using BvhGpu = tests::GpuTest;

constexpr unsigned kSeed = 5;

TriangleMesh soup(std::size_t count) { return tests::random_triangles(count, kSeed); }

Tree build(const TriangleMesh& mesh, const Config& config = {}) {
    BvhBuild job(tests::device(), config);
    job.prepare(mesh);
    taskpool::pool::run(tests::device(), job);
    EXPECT_EQ(job.status().state.live, 0);
    return job.read_back();
}

void expect_valid(const TriangleMesh& mesh, const Tree& tree, const Config& config = {}) {
    const Limits limits{config.max_leaf_size, config.max_depth, true};
    EXPECT_THAT(validate(mesh, tree, limits), testing::IsEmpty())
        << mesh.triangle_count() << " triangles, seed " << kSeed;
}

TEST_F(BvhGpu, IsValidAtEverySize) {
    const std::size_t lanes = tests::device().subgroup_size();
    for (Split split : {Split::binned_sah, Split::spatial_median}) {
        Config config;
        config.split = split;
        for (std::size_t count :
             {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{4}, std::size_t{5},
              lanes - 1, lanes, lanes + 1, std::size_t{63}, std::size_t{65}, std::size_t{1023},
              std::size_t{1024}, std::size_t{1025}, std::size_t{2049}, std::size_t{20000}}) {
            const TriangleMesh mesh = soup(count);
            expect_valid(mesh, build(mesh, config), config);
        }
    }
}

TEST_F(BvhGpu, HoldsAMillionTriangles) {
    const TriangleMesh mesh = soup(1'000'000);
    expect_valid(mesh, build(mesh));
}

TEST_F(BvhGpu, KeepsToItsLeafRules) {
    const TriangleMesh mesh = soup(5000);
    for (std::uint32_t size : {1u, 2u, 4u, 8u})
        for (bool by_cost : {true, false}) {
            Config config;
            config.max_leaf_size = size;
            config.leaf_by_cost = by_cost;
            const Tree tree = build(mesh, config);
            expect_valid(mesh, tree, config);
            if (size == 1) {
                EXPECT_EQ(measure(mesh, tree, {.epo = false}).leaf_size_mean, 1);
            }
        }
}

TEST_F(BvhGpu, CountsAndSkipsDegenerateTriangles) {
    TriangleMesh mesh = soup(5000);
    std::mt19937 random(kSeed);
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        if (random() % 3 == 0) mesh.triangles[i].y = mesh.triangles[i].x;
        if (random() % 9 == 0)  // collinear
            mesh.positions[mesh.triangles[i].z] =
                2.f * mesh.positions[mesh.triangles[i].y] - mesh.positions[mesh.triangles[i].x];
    }
    std::size_t sound = 0;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) sound += !mesh.degenerate(i);
    ASSERT_LT(sound, 4000u);
    const Tree tree = build(mesh);
    EXPECT_EQ(tree.order.size(), sound);
    expect_valid(mesh, tree);

    for (auto& triangle : mesh.triangles) triangle.y = triangle.x;
    const Tree none = build(mesh);
    EXPECT_TRUE(none.empty());
    expect_valid(mesh, none);
}

TEST_F(BvhGpu, BoundsItsDepthOnHardInput) {
    Config config;
    config.max_depth = 40;
    TriangleMesh same = soup(1);
    same.triangles.resize(100'000, same.triangles[0]);
    expect_valid(same, build(same, config), config);

    // Ever smaller steps: planes cut off one triangle at a time.
    TriangleMesh steps;
    for (int i = 0; i < 3000; ++i) {
        const float x = std::ldexp(1.f, -(i % 100)) * (1.f + 0.001f * float(i / 100));
        const auto first = std::uint32_t(steps.positions.size());
        steps.positions.insert(steps.positions.end(), {{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
        steps.triangles.emplace_back(first, first + 1, first + 2);
    }
    expect_valid(steps, build(steps, config), config);
}

TEST_F(BvhGpu, SurvivesExtremeCoordinates) {
    for (float scale : {1e-30f, 1e-10f, 1e10f, 1e17f}) {
        TriangleMesh mesh = soup(3000);
        for (glm::vec3& p : mesh.positions) p *= scale;
        expect_valid(mesh, build(mesh));
    }
    TriangleMesh far = soup(3000);
    for (glm::vec3& p : far.positions) p += 1e6f;
    expect_valid(far, build(far));
}

TEST_F(BvhGpu, CostsLittleMoreThanASweep) {
    const TriangleMesh mesh = soup(30'000);
    const double cost = measure(mesh, build(mesh), {.epo = false}).sah_cost;
    const double sweep = measure(mesh, build_reference(mesh, {}), {.epo = false}).sah_cost;
    EXPECT_LT(cost, 1.05 * sweep);

    Config median;
    median.split = Split::spatial_median;
    ReferenceConfig reference;
    reference.rule = SplitRule::spatial_median;
    EXPECT_LT(measure(mesh, build(mesh, median), {.epo = false}).sah_cost,
              1.05 * measure(mesh, build_reference(mesh, reference), {.epo = false}).sah_cost);
}

TEST_F(BvhGpu, IsTheSameHoweverItIsScheduled) {
    const TriangleMesh mesh = soup(40'000);
    const std::uint64_t expected = fingerprint(build(mesh));
    for (auto policy : {taskpool::pool::Policy::scan, taskpool::pool::Policy::bitmap})
        for (std::uint32_t subgroups : {1u, 2u, 7u}) {
            Config config;
            config.pool.policy = policy;
            config.pool.subgroups = subgroups;
            config.pool.slots = 64;
            EXPECT_EQ(fingerprint(build(mesh, config)), expected);
        }
    Config hasty;
    hasty.pool.iteration_budget = 60'000;
    EXPECT_EQ(fingerprint(build(mesh, hasty)), expected);
}

TEST_F(BvhGpu, KeepsToItsMemoryEstimate) {
    const std::size_t count = 200'000;
    const TriangleMesh mesh = soup(count);
    const std::uint64_t before = tests::device().allocated_bytes();
    BvhBuild job(tests::device(), {});
    job.prepare(mesh);
    const std::size_t input = mesh.positions.size() * 12 + count * 12;
    EXPECT_LE(tests::device().allocated_bytes() - before,
              job.required_bytes(count) + input + 65536);
    // Beside the mesh and the tree, at most 200 bytes a triangle.
    EXPECT_LT(job.required_bytes(count) - BvhBuild::output_bytes(count), 200 * count);
}

TEST_F(BvhGpu, RefusesBadSettings) {
    const auto refuses = [](auto change) {
        Config config;
        change(config);
        EXPECT_THROW(BvhBuild(tests::device(), config), std::invalid_argument);
    };
    refuses([](Config& c) { c.max_leaf_size = 0; });
    refuses([](Config& c) { c.max_leaf_size = 9; });
    refuses([](Config& c) { c.max_depth = 5; });
    refuses([](Config& c) { c.costs.intersection = 0; });
}

}  // namespace
