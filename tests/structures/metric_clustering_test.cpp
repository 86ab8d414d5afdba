// Clusters and their volumes: every clustering is sound, the same whatever the threads, and tight
// where the best volume is known; and the validator finds what is planted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "structures/metric_tree/clustering.hpp"
#include "structures/metric_tree/volume.hpp"
#include "tests/structures/meshes.hpp"

namespace structures::metric_tree {
namespace {

using geometry::TriangleMesh;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Clustering expect_sound(const TriangleMesh& mesh, const ClusterConfig& config) {
    Clustering clustering = cluster(mesh, config);
    EXPECT_THAT(validate(mesh, clustering, config), IsEmpty());
    return clustering;
}

void expect_equal(const Clustering& a, const Clustering& b) {
    EXPECT_EQ(a.order, b.order);
    EXPECT_EQ(a.capsule_count, b.capsule_count);
    ASSERT_EQ(a.clusters.size(), b.clusters.size());
    EXPECT_EQ(
        std::memcmp(a.clusters.data(), b.clusters.data(), a.clusters.size() * sizeof(Cluster)), 0);
}

/// Moved after scaling, corner by corner.
TriangleMesh transformed(TriangleMesh mesh, float scale, glm::vec3 shift) {
    for (glm::vec3& position : mesh.positions) position = position * scale + shift;
    return mesh;
}

/// A closed tube without caps: 2 * sections * sides triangles.
TriangleMesh tube(glm::vec3 from, glm::vec3 to, float radius, int sections, int sides) {
    const glm::vec3 along = glm::normalize(to - from);
    const glm::vec3 right = glm::normalize(
        glm::cross(along, std::abs(along.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(along, right);
    const auto at = [&](int section, int side) {
        const float angle = 6.2831853f * static_cast<float>(side % sides) / sides;
        return glm::mix(from, to, static_cast<float>(section) / sections) +
               radius * (std::cos(angle) * right + std::sin(angle) * up);
    };
    TriangleMesh mesh;
    for (int i = 0; i < sections; ++i)
        for (int j = 0; j < sides; ++j)
            tests::add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    return mesh;
}

std::vector<std::uint32_t> all_of(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> all(mesh.triangle_count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
}

double axis_length(const Cluster& cluster) {
    return glm::distance(glm::dvec3(cluster.a), glm::dvec3(cluster.b));
}

class Clusters : public testing::TestWithParam<std::uint32_t> {
  protected:
    ClusterConfig config() const { return {.max_triangles = GetParam()}; }
};
INSTANTIATE_TEST_SUITE_P(MaxTriangles, Clusters, testing::Values(1, 7, 8, 16, 22, 32, 64));

TEST_P(Clusters, HoldAnyNumberOfTriangles) {
    const std::uint32_t most = GetParam();
    for (const std::uint32_t count :
         {0u, 1u, most - 1, most, most + 1, 511u, 512u, 513u, 1024u, 3000u}) {
        SCOPED_TRACE(testing::Message() << count << " triangles, seed " << count + 1);
        const TriangleMesh mesh = tests::random_triangles(count, count + 1);
        const Clustering clustering = expect_sound(mesh, config());
        EXPECT_THAT(clustering.order, SizeIs(count));
        EXPECT_GE(clustering.clusters.size(), (count + most - 1) / most);
        if (count <= most) {
            EXPECT_THAT(clustering.clusters, SizeIs(count > 0));
        }
        ClusterConfig balls = config();
        balls.capsules = false;
        EXPECT_EQ(expect_sound(mesh, balls).capsule_count, 0);
    }
}

TEST_P(Clusters, FillUpWithDuplicates) {
    const TriangleMesh mesh = tests::identical_triangles(100000);
    const Clustering clustering = expect_sound(mesh, config());
    EXPECT_LE(clustering.clusters.size(), 2 * (100000 / GetParam() + 200));
}

TEST_P(Clusters, HoldTheSphere) {
    const TriangleMesh mesh = tests::sphere(40, 60, {1, 2, 3}, 2);
    const Clustering clustering = expect_sound(mesh, config());
    std::size_t facing_one_way = 0;
    for (const Cluster& cluster : clustering.clusters) {
        EXPECT_LT(cluster.radius, 2);
        facing_one_way += cluster.cone_cosine > 0;
    }
    EXPECT_GT(facing_one_way, 0.95 * static_cast<double>(clustering.clusters.size()));
}

TEST_P(Clusters, StayFlatInAPlane) {
    TriangleMesh mesh;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 50; ++x) {
            const auto at = [](int i, int j) { return glm::vec3(i, 0.5f, j) / 64.0f; };
            tests::add_quad(mesh, at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        }
    for (const Cluster& cluster : expect_sound(mesh, config()).clusters) {
        EXPECT_LT(cluster.slab_high - cluster.slab_low, 2e-6f);
        EXPECT_NEAR(std::abs(cluster.axis.y), 1, 1e-6);
        EXPECT_GT(cluster.cone_cosine, 0.999999f);
    }
}

TEST_P(Clusters, HoldAtAnyScaleAndPlace) {
    const TriangleMesh random = tests::random_triangles(2000, 17);
    for (const float scale : {1e-18f, 1e-4f, 1.0f, 1e4f, 1e18f})
        for (const float shift : {0.0f, 1.0f, 100.0f, 1048576.0f}) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << ", moved by " << shift);
            expect_sound(transformed(random, scale, glm::vec3(shift, -shift, shift) * scale),
                         config());
        }
}

TEST_P(Clusters, ScaleWithTheMeshByPowersOfTwo) {
    const TriangleMesh mesh = tests::random_triangles(1500, 23);
    const Clustering once = cluster(mesh, config());
    for (const float scale : {0x1p-60f, 0x1p20f}) {
        const Clustering scaled = cluster(transformed(mesh, scale, {0, 0, 0}), config());
        EXPECT_EQ(scaled.order, once.order);
        ASSERT_EQ(scaled.clusters.size(), once.clusters.size());
        for (std::size_t c = 0; c < once.clusters.size(); ++c) {
            EXPECT_EQ(scaled.clusters[c].a, once.clusters[c].a * scale);
            EXPECT_EQ(scaled.clusters[c].b, once.clusters[c].b * scale);
            EXPECT_EQ(scaled.clusters[c].radius, once.clusters[c].radius * scale);
            EXPECT_EQ(scaled.clusters[c].axis, once.clusters[c].axis);
        }
    }
}

TEST_P(Clusters, DoNotDependOnThreads) {
    const TriangleMesh mesh = tests::random_triangles(20000, 5);
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return cluster(mesh, config());
    };
    const Clustering alone = with_threads(1);
    for (const std::size_t threads : {2, 3, 8}) expect_equal(alone, with_threads(threads));
}

TEST_P(Clusters, LeaveDegenerateTrianglesOut) {
    const TriangleMesh sound = tests::random_triangles(3000, 31);
    TriangleMesh mixed;
    mixed.positions = sound.positions;
    const auto extra = static_cast<std::uint32_t>(mixed.positions.size());
    const float infinity = std::numeric_limits<float>::infinity();
    mixed.positions.insert(mixed.positions.end(), {{kNan, 0, 0},
                                                   {infinity, 0, 0},
                                                   {0, -infinity, kNan},
                                                   {100, 100, 100},
                                                   {102, 102, 102},
                                                   {104, 104, 104}});
    std::vector<std::uint32_t> names;  // in `mixed`, of the sound ones
    for (std::uint32_t t = 0; t < sound.triangle_count(); ++t) {
        if (t % 3 == 0) mixed.triangles.push_back({t, t + 1, extra + t % 4 % 3});
        if (t % 5 == 0) mixed.triangles.push_back({t, t + 1, t});
        if (t % 7 == 0) mixed.triangles.push_back({extra + 3, extra + 4, extra + 5});
        names.push_back(static_cast<std::uint32_t>(mixed.triangles.size()));
        mixed.triangles.push_back(sound.triangles[t]);
    }
    Clustering expected = expect_sound(sound, config());
    for (std::uint32_t& triangle : expected.order) triangle = names[triangle];
    expect_equal(expect_sound(mixed, config()), expected);

    mixed.triangles.assign(1000, {0, 0, 1});
    EXPECT_THAT(expect_sound(mixed, config()).clusters, IsEmpty());
}

TEST_P(Clusters, ReportProgressUpToOne) {
    std::vector<double> shares;
    cluster(tests::random_triangles(10000, 3), config(),
            [&](double share) { shares.push_back(share); });
    ASSERT_THAT(shares, testing::Not(IsEmpty()));
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GT(shares.front(), 0);
    EXPECT_EQ(shares.back(), 1);
}

TEST(ClusterConfigs, OutOfRangeAreRejected) {
    for (const std::uint32_t most : {0u, 65u, 0xffffffffu})
        EXPECT_THROW(cluster({}, {.max_triangles = most}), std::invalid_argument);
}

TEST(ClusterProgress, MayEndTheWorkByThrowing) {
    EXPECT_THROW(cluster(tests::random_triangles(10000, 3), {},
                         [](double) { throw std::runtime_error("enough"); }),
                 std::runtime_error);
}

TEST(Volumes, CablesAreCapsules) {
    TriangleMesh cables;
    for (int i = 0; i < 20; ++i) {
        const auto x = static_cast<float>(i);
        const TriangleMesh cable = tube({x, 0, 0.1f * x}, {x + 0.3f, 10, -0.2f * x}, 0.01f, 32, 4);
        for (std::size_t t = 0; t < cable.triangle_count(); ++t)
            tests::add_triangle(cables, cable.corner(t, 0), cable.corner(t, 1), cable.corner(t, 2));
    }
    const Clustering clustering = expect_sound(cables, {.max_triangles = 16});
    const auto thin = std::count_if(
        clustering.clusters.begin(), clustering.clusters.end(),
        [](const Cluster& cluster) { return cluster.a != cluster.b && cluster.radius < 0.02f; });
    EXPECT_GT(thin, 0.9 * static_cast<double>(clustering.clusters.size()));
}

TEST(Volumes, CapsulesAreNoLongerThanNeeded) {
    // A tube with hemispheres for ends would touch its capsule everywhere; without them the
    // capsule's caps pass through the rims, so that the axis is as long as the tube.
    const TriangleMesh mesh = tube({1, 2, 3}, {4, 6, 15}, 0.5f, 20, 24);
    const Cluster open = fit_volume(mesh, all_of(mesh), true);
    EXPECT_NEAR(axis_length(open), 13, 5e-3);
    EXPECT_NEAR(open.radius, 0.5, 1e-3);
    // One more point at each tip of the hemispheres changes nothing.
    TriangleMesh tipped = mesh;
    const glm::vec3 along = glm::normalize(glm::vec3(3, 4, 12)), from{1, 2, 3}, to{4, 6, 15};
    tests::add_triangle(tipped, from - 0.4999f * along, from, from + glm::vec3(0.1f, 0, 0));
    tests::add_triangle(tipped, to + 0.4999f * along, to, to + glm::vec3(0.1f, 0, 0));
    const Cluster closed = fit_volume(tipped, all_of(tipped), true);
    EXPECT_NEAR(axis_length(closed), 13, 5e-3);
    EXPECT_NEAR(closed.radius, 0.5, 1e-3);
}

TEST(Volumes, BallsAreTheSmallest) {
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const TriangleMesh mesh = tests::random_triangles(1 + seed % 4, seed, 0.5f);
        const std::vector<glm::vec3>& points = mesh.positions;
        // M. Badoiu and K. Clarkson, "Smaller core-sets for balls", 2003: ever shorter steps to the
        // farthest point end in the center.
        glm::dvec3 center = points[0], farthest = center;
        double reach = 0;
        for (int i = 1; i <= 20000; ++i) {
            reach = 0;
            for (const glm::dvec3 point : points) {
                const double distance = glm::distance(center, point);
                if (distance > reach) reach = distance, farthest = point;
            }
            center += (farthest - center) / (i + 1.0);
        }
        const Cluster ball = fit_volume(mesh, all_of(mesh), false);
        EXPECT_LE(ball.radius, reach * (1 + 1e-5));
        EXPECT_GE(ball.radius, reach * (1 - 1e-3));
    }
}

TEST(Volumes, ConesThatAreNoneCoverEverything) {
    TriangleMesh mesh;  // a closed box, and a triangle seen from both sides
    tests::add_box(mesh, {0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(fit_volume(mesh, all_of(mesh), true).cone_cosine, -1);
    TriangleMesh both;
    tests::add_triangle(both, {0, 0, 5}, {1, 0, 5}, {0, 1, 5});
    tests::add_triangle(both, {0, 0, 5}, {0, 1, 5}, {1, 0, 5});
    const Cluster flat = fit_volume(both, all_of(both), true);
    EXPECT_EQ(flat.cone_cosine, -1);
    EXPECT_LT(flat.slab_high - flat.slab_low, 1e-5f) << "a slab has no front";
    // A right angle between two faces: 45 degrees about the middle.
    TriangleMesh edge;
    tests::add_quad(edge, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    tests::add_quad(edge, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    const Cluster bent = fit_volume(edge, all_of(edge), true);
    EXPECT_NEAR(bent.cone_cosine, std::sqrt(0.5), 1e-6);
    EXPECT_LT(bent.cone_cosine, std::sqrt(0.5));
}

TEST(Volumes, AllowForTheRoundingOfSliversNormals) {
    // Next to no area: the direction of the computed normal is worth nothing.
    TriangleMesh sliver;
    tests::add_triangle(sliver, {0, 0, 0}, {16777216, 16777215, 16777213},
                        {16777214, 16777213, 16777211});
    ASSERT_FALSE(sliver.degenerate(0));
    const Cluster cluster = fit_volume(sliver, all_of(sliver), true);
    EXPECT_LT(cluster.cone_cosine, 1);
    EXPECT_THAT(expect_sound(sliver, {}).clusters, SizeIs(1));
}

TEST(Volumes, MeasureDistancesToTheirAxis) {
    Cluster capsule{};
    capsule.a = {1, 0, 0};
    capsule.b = {5, 0, 0};
    EXPECT_EQ(distance_to_axis(capsule, {3, 2, 0}), 2);
    EXPECT_EQ(distance_to_axis(capsule, {-2, 4, 0}), 5);
    EXPECT_EQ(distance_to_axis(capsule, {8, 0, -4}), 5);
    capsule.b = capsule.a;
    EXPECT_EQ(distance_to_axis(capsule, {4, 4, 0}), 5);
}

class ClusteringValidate : public testing::Test {
  protected:
    ClusteringValidate() : mesh_(tests::random_triangles(200, 42)), config_{.max_triangles = 16} {
        mesh_.triangles.push_back({0, 0, 1});  // degenerate: 200
        clustering_ = cluster(mesh_, config_);
    }
    std::vector<Cluster>& all() { return clustering_.clusters; }
    Cluster& first() { return all()[0]; }
    void expect_violation(const char* text) {
        EXPECT_THAT(validate(mesh_, clustering_, config_), Contains(HasSubstr(text)));
        clustering_ = cluster(mesh_, config_);
    }

    TriangleMesh mesh_;
    ClusterConfig config_;
    Clustering clustering_;
};

TEST_F(ClusteringValidate, SoundOnesPass) {
    EXPECT_THAT(validate(mesh_, clustering_, config_), IsEmpty());
    EXPECT_THAT(validate({}, {}, {}), IsEmpty());
}

TEST_F(ClusteringValidate, FindsBrokenRanges) {
    --first().count;
    expect_violation("begins at");
    first().count = 0;
    expect_violation("0 triangles instead of 1 to 16");
    config_.max_triangles = first().count - 1;
    EXPECT_THAT(validate(mesh_, clustering_, config_), Contains(HasSubstr("triangles instead of")));
    config_.max_triangles = 16;
    all().back().count = 0xffffffffu;
    expect_violation("exceeds the 200 triangles");
    all().pop_back();
    expect_violation("the last cluster ends at");
}

TEST_F(ClusteringValidate, FindsTrianglesInTheWrongPlace) {
    clustering_.order[0] = clustering_.order[1];
    expect_violation("in 2 clusters");
    clustering_.order[0] = clustering_.order[1];
    expect_violation("in 0 clusters");
    clustering_.order[0] = 200;
    expect_violation("degenerate, yet in a cluster");
    clustering_.order[0] = 201;
    expect_violation("triangle 201 of 201 does not exist");
}

TEST_F(ClusteringValidate, FindsVolumesThatDoNotEnclose) {
    first().radius *= 0.99f;
    expect_violation("from the axis, the radius");
    first().a.x = first().b.x = kNan;
    expect_violation("from the axis, the radius");
    first().radius = kNan;
    expect_violation("from the axis, the radius");
    first().slab_high = std::nextafter(first().slab_low, 10.0f);
    expect_violation("the slab from");
    first().slab_low = kNan;
    expect_violation("the slab from");
    first().cone_cosine = 1;
    expect_violation("has cosine");
    first().cone_cosine = kNan;
    expect_violation("cone_cosine nan");
    first().axis *= 1.001f;
    expect_violation("an axis of length");
}

TEST_F(ClusteringValidate, FindsCapsulesThatShouldNotBe) {
    ++clustering_.capsule_count;
    expect_violation("capsule_count is");
    config_.capsules = false;
    clustering_ = cluster(mesh_, config_);
    first().b.x = std::nextafter(first().b.x, 10.0f);
    expect_violation("a capsule where balls were asked for");
}

TEST_F(ClusteringValidate, ListsNoMoreThanTwentyLines) {
    for (Cluster& cluster : all()) cluster.radius = -1;
    EXPECT_THAT(validate(mesh_, clustering_, config_), SizeIs(21));
}

}  // namespace
}  // namespace structures::metric_tree
