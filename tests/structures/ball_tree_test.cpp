// The ball tree: equal to its CPU reference bit for bit, and its queries to looking at all points.
#include <gmock/gmock.h>

#include <cmath>

#include "structures/ball_tree/reference.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace structures::ball_tree {
namespace {

using namespace taskpool;
using tests::TriangleMesh;

using BallTree = tests::GpuTest;

/// Triangles at all scales: edges and distances from the origin between 10^-6 and 10^6.
TriangleMesh scales(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1), exponent(-6, 6);
    TriangleMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const float scale = std::pow(10.0f, exponent(random));
        const auto corner = [&] {
            return scale * glm::vec3(unit(random), unit(random), unit(random));
        };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        tests::add_triangle(mesh, a, b, c);
    }
    return mesh;
}

/// One triangle per power of two: splitting in the middle would cut off one at a time.
TriangleMesh powers_of_two(int count) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const float s = std::ldexp(1.0f, i - count / 2);
        tests::add_triangle(mesh, {s, 0, 0}, {0, s, 0}, {0, 0, s});
    }
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, float factor) {
    for (glm::vec3& position : mesh.positions) position *= factor;
    return mesh;
}

/// Every third triangle degenerate, and runs of copies.
TriangleMesh mixed(std::size_t count, std::uint32_t seed) {
    TriangleMesh mesh = tests::random_triangles(count, seed);
    for (std::size_t i = 0; i < count; i += 3) mesh.triangles[i].z = mesh.triangles[i].x;
    for (std::size_t i = count / 2; i < count * 3 / 4; ++i)
        if (i % 3 != 0) mesh.triangles[i] = mesh.triangles[count / 2 + (count / 2 % 3 == 0)];
    return mesh;
}

std::vector<TriangleMesh> meshes(std::uint32_t seed) {
    std::vector<TriangleMesh> all;
    const std::uint32_t lanes = tests::device().subgroup_size();
    for (const std::uint32_t count :
         {0u, 1u, 2u, 8u, 9u, lanes - 1, lanes, lanes + 1, 1023u, 1024u, 2047u, 2048u, 2049u})
        all.push_back(tests::random_triangles(count, seed + count));
    all.push_back(tests::identical_triangles(10'000));
    all.push_back(mixed(5'000, seed));
    all.push_back(scales(20'000, seed));
    all.push_back(powers_of_two(110));
    // Squared distances overflow, or are all 0.
    for (const float factor : {1e30f, 1e-30f})
        all.push_back(scaled(tests::random_triangles(500, seed), factor));
    all.push_back(tests::sphere(100, 200, {1, 2, 3}, 4));
    return all;
}

void expect_equal(const Tree& tree, const Tree& expected) {
    ASSERT_EQ(tree.points.size(), expected.points.size());
    for (std::size_t i = 0; i < tree.points.size(); ++i) {
        ASSERT_EQ(tree.points[i].id, expected.points[i].id) << "point " << i;
        ASSERT_EQ(tree.points[i].position, expected.points[i].position) << "point " << i;
    }
    std::vector<BallNode> nodes, expected_nodes;
    walk(tree, [&](const BallNode& node, std::uint32_t) { nodes.push_back(node); });
    walk(expected, [&](const BallNode& node, std::uint32_t) { expected_nodes.push_back(node); });
    ASSERT_EQ(nodes.size(), expected_nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        ASSERT_EQ(nodes[i].center, expected_nodes[i].center) << "node " << i << " in preorder";
        ASSERT_EQ(nodes[i].radius_squared, expected_nodes[i].radius_squared) << "node " << i;
        ASSERT_EQ(nodes[i].first, expected_nodes[i].first) << "node " << i;
        ASSERT_EQ(nodes[i].count, expected_nodes[i].count) << "node " << i;
    }
}

TEST_F(BallTree, EqualsItsReference) {
    for (const std::uint32_t leaf_size : {1u, 8u, 64u}) {
        BallTreeBuild build(tests::device(), {.leaf_size = leaf_size});
        for (const TriangleMesh& mesh : meshes(31)) {
            SCOPED_TRACE(testing::Message() << mesh.triangle_count() << " triangles, leaves of "
                                            << leaf_size << ", seed 31");
            build.prepare(mesh);
            pool::run(tests::device(), build);
            const Tree tree = build.read_back();
            EXPECT_THAT(validate(mesh, tree, leaf_size), testing::IsEmpty());
            ASSERT_NO_FATAL_FAILURE(expect_equal(tree, build_reference(mesh, leaf_size)));
        }
    }
}

TEST_F(BallTree, DoesNotDependOnThePool) {
    const TriangleMesh mesh = mixed(15'000, 5);
    const Tree expected = build_reference(mesh, 8);
    for (const pool::Policy policy : {pool::Policy::scan, pool::Policy::bitmap})
        for (const std::uint32_t workgroups : {1u, 64u})
            for (const std::uint32_t budget : {1u << 30, 3000u}) {
                SCOPED_TRACE(testing::Message() << workgroups << " workgroups, budget " << budget);
                Config config;
                config.pool.policy = policy;
                config.pool.slots = 64;
                config.pool.subgroups = workgroups;
                config.pool.iteration_budget = budget;
                BallTreeBuild build(tests::device(), config);
                build.prepare(mesh);
                const pool::RunStats stats = pool::run(tests::device(), build);
                if (budget == 3000) {
                    EXPECT_GT(stats.launches, 1u);
                }
                ASSERT_NO_FATAL_FAILURE(expect_equal(build.read_back(), expected));
            }
}

/// Nearest points of random positions in and around the mesh, and of its own corners.
void check_queries(const NearestQuery& query, const BallTreeBuild& build, const TriangleMesh& mesh,
                   std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    geometry::Aabb box = mesh.bounds();
    if (box.empty()) box = {glm::vec3(0), glm::vec3(1)};
    std::uniform_real_distribution<float> unit(-0.5f, 1.5f);
    std::vector<glm::vec3> positions;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 place(unit(random), unit(random), unit(random));
        const bool corner = i % 4 == 0 && !mesh.positions.empty();
        positions.push_back(corner ? mesh.positions[random() % mesh.positions.size()]
                                   : box.lower + place * box.extent());
    }
    gpu::Device& device = tests::device();
    const gpu::Buffer input = gpu::make_buffer<glm::vec3>(device, positions, "queries");
    const gpu::Buffer output(device, count * sizeof(Nearest), "nearest points");
    gpu::Recorder recorder(device);
    query.record(recorder, build, input, output, std::uint32_t(count));
    recorder.barrier();
    device.run(recorder);
    const auto results = gpu::read<Nearest>(output, count);
    const std::vector<BallPoint> points = build.read_back().points;
    for (std::size_t i = 0; i < count; ++i) {
        const Nearest expected = nearest_of_all(points, positions[i]);
        ASSERT_EQ(results[i].distance_squared, expected.distance_squared)
            << "query " << i << ", seed " << seed;
        ASSERT_EQ(results[i].id == kNoPoint, points.empty());
        if (points.empty()) continue;
        // Of several nearest points, any one.
        ASSERT_LT(results[i].id, mesh.triangle_count());
        const auto found = std::find_if(points.begin(), points.end(), [&](const BallPoint& point) {
            return point.id == results[i].id;
        });
        ASSERT_NE(found, points.end());
        ASSERT_EQ(nearest_of_all(std::span(&*found, 1), positions[i]).distance_squared,
                  expected.distance_squared);
    }
}

TEST_F(BallTree, FindsTheNearestPoint) {
    const NearestQuery query(tests::device());
    BallTreeBuild build(tests::device(), {});
    for (std::uint32_t seed = 1; seed <= 3; ++seed)
        for (const TriangleMesh& mesh : meshes(seed)) {
            SCOPED_TRACE(testing::Message() << mesh.triangle_count() << " triangles");
            build.prepare(mesh);
            pool::run(tests::device(), build);
            ASSERT_NO_FATAL_FAILURE(check_queries(query, build, mesh, 200, seed));
        }
}

TEST_F(BallTree, HoldsAMillionPoints) {
    const TriangleMesh mesh = tests::random_triangles(1'000'000, 77, 0.001f);
    BallTreeBuild build(tests::device(), {});
    build.prepare(mesh);
    pool::run(tests::device(), build);
    ASSERT_NO_FATAL_FAILURE(expect_equal(build.read_back(), build_reference(mesh, 8)));
    ASSERT_NO_FATAL_FAILURE(check_queries(NearestQuery(tests::device()), build, mesh, 100, 77));
}

TEST_F(BallTree, RefusesBadLeafSizes) {
    for (const std::uint32_t leaf_size : {0u, 65u})
        EXPECT_THROW(BallTreeBuild(tests::device(), {.leaf_size = leaf_size}),
                     std::invalid_argument);
}

TEST(BallTreeValidate, FindsWhatIsWrong) {
    const TriangleMesh mesh = tests::random_triangles(100, 4);
    const Tree good = build_reference(mesh, 8);
    ASSERT_THAT(validate(mesh, good, 8), testing::IsEmpty());
    const auto expect_found = [&](const char* what, auto&& spoil) {
        Tree tree = good;
        spoil(tree);
        EXPECT_THAT(validate(mesh, tree, 8), testing::Not(testing::IsEmpty())) << what;
    };
    expect_found("small ball", [](Tree& t) { t.nodes[0].radius_squared *= 0.9f; });
    expect_found("cycle", [](Tree& t) { t.nodes[t.nodes[0].first] = t.nodes[0]; });
    expect_found("orphans", [](Tree& t) { t.nodes[0].first = t.nodes[0].count = 0; });
    expect_found("child far outside", [](Tree& t) { t.nodes[0].first = 0x7fffffff; });
    expect_found("point twice", [](Tree& t) { t.points[3] = t.points[4]; });
    expect_found("point moved", [](Tree& t) { t.points[3].position.x += 1e-6f; });
    expect_found("point lost", [](Tree& t) { t.points.pop_back(); });
    EXPECT_THAT(validate(mesh, good, 4), testing::Not(testing::IsEmpty())) << "large leaves";
}

}  // namespace
}  // namespace structures::ball_tree
