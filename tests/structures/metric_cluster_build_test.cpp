// Clusters made on the device: sound for any mesh, the same from any pool, hardly looser than the
// host's.
#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "structures/metric_tree/cluster_build.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace structures::metric_tree;
using namespace taskpool;
using testing::IsEmpty;
using testing::SizeIs;
using tests::TriangleMesh;

class MetricClusterBuild : public tests::GpuTest {
  protected:
    static Clustering run(ClusterBuild& build, const TriangleMesh& mesh) {
        build.prepare(mesh);
        pool::run(tests::device(), build);
        EXPECT_EQ(build.progress(), 1);
        return build.read_back();
    }
    static Clustering expect_sound(const TriangleMesh& mesh, const ClusterConfig& config) {
        ClusterBuild build(tests::device(), config);
        Clustering clustering = run(build, mesh);
        EXPECT_THAT(validate(mesh, clustering, config), IsEmpty());
        return clustering;
    }
    static void expect_equal(const Clustering& a, const Clustering& b) {
        EXPECT_EQ(a.order, b.order);
        ASSERT_EQ(a.clusters.size(), b.clusters.size());
        EXPECT_EQ(
            std::memcmp(a.clusters.data(), b.clusters.data(), a.clusters.size() * sizeof(Cluster)),
            0);
    }
};

TEST_F(MetricClusterBuild, HoldsAnyNumberOfTriangles) {
    for (const std::uint32_t most : {1u, 16u, 64u}) {
        const ClusterConfig config{.max_triangles = most};
        ClusterBuild build(tests::device(), config);
        for (const std::uint32_t count :
             {0u, 1u, most - 1, most, most + 1, 511u, 512u, 513u, 5000u}) {
            SCOPED_TRACE(testing::Message() << count << " triangles, " << most << " in a cluster, "
                                            << "seed " << count + 1);
            const TriangleMesh mesh = tests::random_triangles(count, count + 1);
            const Clustering clustering = run(build, mesh);
            EXPECT_THAT(validate(mesh, clustering, config), IsEmpty());
            EXPECT_THAT(clustering.order, SizeIs(count));
        }
    }
}

TEST_F(MetricClusterBuild, MakesBallsOnly) {
    const ClusterConfig config{.max_triangles = 4, .capsules = false};
    EXPECT_EQ(expect_sound(tests::random_triangles(3000, 9), config).capsule_count, 0);
}

TEST_F(MetricClusterBuild, FillsUpWithDuplicates) {
    const Clustering clustering = expect_sound(tests::identical_triangles(100000), {});
    EXPECT_LE(clustering.clusters.size(), 2 * (100000 / 16 + 200));
}

TEST_F(MetricClusterBuild, HoldsAtAnyScaleAndPlace) {
    const TriangleMesh random = tests::random_triangles(2000, 17);
    ClusterBuild build(tests::device(), {});
    for (const float scale : {1e-15f, 1e-4f, 1e4f, 1e15f})
        for (const float shift : {0.0f, 100.0f, 1048576.0f}) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << ", moved by " << shift);
            TriangleMesh mesh = random;
            for (glm::vec3& position : mesh.positions)
                position = (position + glm::vec3(shift, -shift, shift)) * scale;
            EXPECT_THAT(validate(mesh, run(build, mesh), {}), IsEmpty());
        }
}

TEST_F(MetricClusterBuild, LeavesDegenerateTrianglesOut) {
    TriangleMesh mesh = tests::random_triangles(3000, 31);
    const auto extra = static_cast<std::uint32_t>(mesh.positions.size());
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.positions.insert(mesh.positions.end(), {{nan, 0, 0}, {infinity, 0, -infinity}});
    for (std::uint32_t t = 0; t < 3000; t += 3) {
        mesh.triangles[t] =
            t % 2 == 0 ? glm::uvec3(t, t + 1, extra + t % 4 / 2) : glm::uvec3(t, t + 1, t);
    }
    EXPECT_THAT(expect_sound(mesh, {}).order, SizeIs(2000));
    mesh.triangles.assign(1000, {0, 0, extra});
    EXPECT_THAT(expect_sound(mesh, {}).clusters, IsEmpty());
}

TEST_F(MetricClusterBuild, BoundsSlivers) {
    TriangleMesh mesh;  // along a line, as far as single precision can tell
    for (int i = 0; i < 300; ++i) {
        const auto x = static_cast<float>(i);
        tests::add_triangle(mesh, {x, x, x}, {x + 16777, x + 16776, x + 16774},
                            {x + 16775, x + 16774, x + 16772.001f});
    }
    expect_sound(mesh, {});
}

TEST_F(MetricClusterBuild, DoesNotDependOnThePool) {
    const TriangleMesh mesh = tests::random_triangles(20000, 5);
    const Clustering expected = expect_sound(mesh, {});
    const pool::PoolConfig pools[] = {
        {.policy = pool::Policy::scan, .slots = 64, .subgroups = 1},
        {.slots = 64, .subgroups = 7, .private_chunks = 1},
        {.subgroups = 3, .private_chunks = 4, .iteration_budget = 30000},
        {.subgroups = 64, .min_chunks = 1, .private_chunks = 1},
    };
    for (const pool::PoolConfig& config : pools) {
        ClusterBuild build(tests::device(), {}, config);
        expect_equal(run(build, mesh), expected);
    }
}

TEST_F(MetricClusterBuild, IsHardlyLooserThanTheHosts) {
    const auto looks = [](const Clustering& clustering) {
        double area = 0;
        for (const Cluster& cluster : clustering.clusters)
            area += cluster.radius *
                    (3.14159 * cluster.radius + 2 * glm::distance(cluster.a, cluster.b));
        return area;
    };
    const TriangleMesh meshes[] = {tests::sphere(100, 120, {1, 2, 3}, 2),
                                   tests::random_triangles(20000, 77, 0.01f)};
    for (const bool capsules : {false, true}) {
        const ClusterConfig config{.max_triangles = 16, .capsules = capsules};
        ClusterBuild build(tests::device(), config);
        for (const TriangleMesh& mesh : meshes) {
            const Clustering here = cluster(mesh, config), there = run(build, mesh);
            EXPECT_THAT(validate(mesh, there, config), IsEmpty());
            EXPECT_LT(looks(there), 1.15 * looks(here));
            EXPECT_LT(static_cast<double>(there.clusters.size()),
                      1.1 * static_cast<double>(here.clusters.size()));
        }
    }
}

TEST_F(MetricClusterBuild, RejectsConfigsOutOfRange) {
    for (const std::uint32_t most : {0u, 65u})
        EXPECT_THROW(ClusterBuild(tests::device(), {.max_triangles = most}), std::invalid_argument);
}

}  // namespace
