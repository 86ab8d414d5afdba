// Metric trees built on the device, by every builder: valid whatever the order, the pool, the light
// and the clusters.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <numbers>
#include <set>

#include "structures/metric_tree/build.hpp"
#include "structures/metric_tree/reference.hpp"
#include "structures/structure.hpp"
#include "tests/structures/clusters.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace structures::metric_tree;
using namespace taskpool;
using tests::Clustering;
using tests::Light;
using tests::make_cluster;
using tests::Random;

constexpr Light kOutside{Light::Type::point, {0.3f, 4, 0.2f}};
constexpr Light kInside{Light::Type::point, {0.1f, 0.2f, -0.1f}};
constexpr Light kFar{Light::Type::point, {3000, 10'000, -2000}};
constexpr Light kSun{Light::Type::directional, {1, -3, 0.5f}};

/// The build takes no more of it than its bounds.
tests::TriangleMesh mesh_around(const Clustering& clustering) {
    tests::TriangleMesh mesh;
    const tests::Aabb box = tests::bounds_of(clustering);
    if (!box.empty()) tests::add_triangle(mesh, box.lower, box.upper, box.center());
    return mesh;
}

class MetricBuild : public tests::GpuTest, public testing::WithParamInterface<BuilderKind> {
  protected:
    static Tree run(MetricTreeBuild& build, const Clustering& clustering, const Light& light) {
        build.prepare(clustering, mesh_around(clustering));
        build.set_light(light);
        pool::run(tests::device(), build);
        return build.read_back();
    }
    static Tree build(const Clustering& clustering, const Light& light, BuildConfig config = {}) {
        config.builder = GetParam();
        MetricTreeBuild build(tests::device(), config);
        return run(build, clustering, light);
    }
    static bool same_bits(const Tree& a, const Tree& b) {
        return std::memcmp(&a.header, &b.header, sizeof(MetricHeader)) == 0 &&
               a.nodes.size() == b.nodes.size() &&
               std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(MetricNode)) ==
                   0;
    }
    static void expect_valid(const Clustering& clustering, const Tree& tree) {
        EXPECT_THAT(validate(clustering, tree), testing::IsEmpty());
        const MetricHeader& header = tree.header;
        EXPECT_EQ(header.inserted + header.special_count + header.culled_facing,
                  clustering.clusters.size());
        EXPECT_LE(header.depth_max, kMaxDepth);
    }
};

TEST_P(MetricBuild, IsValidForAllSizesAndLights) {
    const std::uint32_t lanes = tests::device().subgroup_size();
    MetricTreeBuild build(tests::device(), {.builder = GetParam()});
    for (const std::uint32_t count :
         std::set<std::uint32_t>{0, 1, 2, lanes - 1, lanes, lanes + 1, 1000})
        for (const bool capsules : {false, true})
            for (const Light& light : {kOutside, kInside, kFar, kSun}) {
                SCOPED_TRACE(testing::Message() << count << " clusters, capsules " << capsules
                                                << ", light at " << light.vector.x);
                const Clustering clustering = tests::random_clusters(count, capsules, 7 + count);
                expect_valid(clustering, run(build, clustering, light));
            }
}

TEST_P(MetricBuild, IsValidForManyClusters) {
    const Clustering clustering = tests::random_clusters(100'000, true, 11);
    for (const Light& light : {kOutside, kInside, kSun}) {
        const Tree tree = build(clustering, light);
        expect_valid(clustering, tree);
        EXPECT_LE(tree.header.bucketed, GetParam() == BuilderKind::insertion ? 0u : 20'000u);
    }
}

TEST_P(MetricBuild, IsValidInAnyOrderAndPool) {
    const Clustering clustering = tests::random_clusters(3000, true, 5);
    const auto expect_found = [&](const BuildConfig& config) {
        for (const Light& light : {kInside, kSun})
            expect_valid(clustering, build(clustering, light, config));
    };
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        expect_found({.seed = seed * 0x9e3779b97f4a7c15});
    }
    for (const pool::Policy policy : {pool::Policy::scan, pool::Policy::bitmap})
        for (const std::uint32_t workgroups : {1u, 3u, 16u}) {
            SCOPED_TRACE(testing::Message() << workgroups << " workgroups");
            BuildConfig config;
            config.pool.policy = policy;
            config.pool.subgroups = workgroups;
            config.pool.slots = 64;
            config.pool.iteration_budget = 60'000;
            expect_found(config);
        }
}

TEST_P(MetricBuild, IsValidAtAnyScaleAndPlace) {
    for (const auto& [scale, shift] : {std::pair{1e-4f, 0.0f},
                                       {1e4f, 0.0f},
                                       {1e-30f, 0.0f},
                                       {1e15f, 0.0f},
                                       {1.0f, 0x1p20f},
                                       {100.0f, -0x1p20f}}) {
        SCOPED_TRACE(testing::Message() << "times " << scale << ", moved by " << shift);
        Clustering clustering = tests::random_clusters(1000, true, 61);
        for (Cluster& cluster : clustering.clusters) {
            cluster.a = cluster.a * scale + shift;
            cluster.b = cluster.b * scale + shift;
            cluster.radius *= scale;
        }
        for (Light light : {kOutside, kInside, kSun}) {
            if (light.type == Light::Type::point) light.vector = light.vector * scale + shift;
            expect_valid(clustering, build(clustering, light));
        }
    }
}

TEST_P(MetricBuild, IsTheSameWhateverThePool) {
    if (GetParam() == BuilderKind::insertion)
        GTEST_SKIP()
            << "which of two lanes puts its node at a link first is left to chance, and so "
               "is the tree; that any is valid is tested above";
    const Clustering clustering = tests::random_clusters(20'000, true, 17);
    for (const Light& light : {kOutside, kSun}) {
        const Tree first = build(clustering, light);
        EXPECT_TRUE(same_bits(first, build(clustering, light)));
        for (const std::uint32_t workgroups : {1u, 5u, 16u}) {
            BuildConfig config;
            config.pool.policy = workgroups == 5 ? pool::Policy::scan : pool::Policy::bitmap;
            config.pool.subgroups = workgroups;
            config.pool.slots = 64;
            config.pool.iteration_budget = 60'000;
            EXPECT_TRUE(same_bits(first, build(clustering, light, config))) << workgroups;
        }
    }
}

TEST_P(MetricBuild, GivesAnotherTreeForAnotherSeed) {
    const Clustering clustering = tests::random_clusters(1000, false, 5);
    std::set<std::uint32_t> roots;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        BuildConfig config{.seed = seed};
        config.pool.subgroups = 1;
        roots.insert(build(clustering, kOutside, config).header.root);
    }
    EXPECT_GT(roots.size(), 1u);
}

TEST_P(MetricBuild, BoundsPathsWhereAllOverlap) {
    // Copies of one cluster; clusters in a row from the light; spokes that all cross.
    Clustering copies, row, spokes;
    for (int i = 0; i < 10'000; ++i)
        copies.clusters.push_back(make_cluster({0, 0, 0}, {0, 0, 0}, 0.1));
    for (int i = 0; i < 10'000; ++i) {
        const glm::dvec3 end(0, 0, -5 - 0.05 * i);
        row.clusters.push_back(
            make_cluster(end, i % 2 == 0 ? end : end + glm::dvec3(0, 0, 0.04), 0.1));
    }
    for (int i = 0; i < 5000; ++i) {
        const double turn = std::numbers::pi * i / 5000;
        const glm::dvec3 end(std::cos(turn), 0, std::sin(turn));
        spokes.clusters.push_back(make_cluster(-end, end, 0.01));
    }
    for (const Clustering* clustering : {&copies, &row, &spokes})
        for (const Light& light : {kOutside, kSun, Light{Light::Type::point, {0, 0, 3}},
                                   Light{Light::Type::directional, {0, 0, -1}}}) {
            SCOPED_TRACE(testing::Message() << clustering->clusters.size() << " clusters, light at "
                                            << light.vector.z);
            expect_valid(*clustering, build(*clustering, light));
        }
    for (int i = 0; i < 90'000; ++i) copies.clusters.push_back(copies.clusters[0]);
    const Tree tree = build(copies, kOutside);
    expect_valid(copies, tree);
    EXPECT_GE(tree.header.bucketed, 100'000 - kMaxDepth);
}

TEST_P(MetricBuild, ListsWhatIsAroundTheLight) {
    const Light light{Light::Type::point, {1, 2, 3}};
    const glm::dvec3 at(light.vector);
    Clustering clustering = tests::random_clusters(500, true, 21);
    const std::size_t others = clustering.clusters.size();
    for (int i = 0; i < 20; ++i) {
        clustering.clusters.push_back(make_cluster(at, at, 0.5));  // within a ball
        clustering.clusters.push_back(make_cluster(at, at, 0));    // at a point
        clustering.clusters.push_back(
            make_cluster(at + glm::dvec3(1, 0, 0), at + glm::dvec3(1, 0, 0), 1));  // touching
        clustering.clusters.push_back(
            make_cluster(at, at + glm::dvec3(0, 3, 0), 0.1));  // at an end
        clustering.clusters.push_back(
            make_cluster(at - glm::dvec3(0, 0, 2), at + glm::dvec3(0, 0, 2), 0.2));  // on the axis
        clustering.clusters.push_back(
            make_cluster(at + glm::dvec3(-5, 1, 0), at + glm::dvec3(5, 1, 0), 0.01));  // passing
    }
    for (const std::uint32_t workgroups : {0u, 7u}) {
        BuildConfig config;
        config.pool.subgroups = workgroups;
        const Tree tree = build(clustering, light, config);
        expect_valid(clustering, tree);
        std::set<std::uint32_t> special(tree.special.begin(), tree.special.end());
        for (std::size_t i = others; i < clustering.clusters.size(); ++i)
            EXPECT_TRUE(special.contains(std::uint32_t(i))) << "cluster " << i;
    }
}

TEST_P(MetricBuild, LeavesOutWhatFacesAway) {
    Clustering clustering = tests::random_clusters(4000, true, 31);
    Random random(31);
    for (Cluster& cluster : clustering.clusters) {
        cluster.axis = random.direction();
        cluster.cone_cosine = static_cast<float>(random.uniform(0.2, 1));
    }
    for (const Light& light : {kOutside, kInside, kSun}) {
        const Tree tree = build(clustering, light, {.cull_facing = true});
        expect_valid(clustering, tree);
        EXPECT_GT(tree.header.culled_facing, 400u);
        EXPECT_EQ(build(clustering, light).header.culled_facing, 0u);
    }
}

TEST_P(MetricBuild, LoadsTreesBuiltElsewhere) {
    Clustering clustering = tests::random_clusters(700, true, 41);
    const tests::TriangleMesh mesh = mesh_around(clustering);
    MetricTreeBuild target(tests::device(), {.builder = GetParam()});
    target.prepare(clustering, mesh);
    for (const Light& light : {kOutside, kInside, kSun}) {
        const Tree tree = build_reference(clustering, mesh.bounds(), light);
        target.load(tree);
        const Tree loaded = target.read_back();
        expect_valid(clustering, loaded);
        EXPECT_EQ(loaded.header.root, tree.header.root);
        EXPECT_EQ(std::set(loaded.special.begin(), loaded.special.end()),
                  std::set(tree.special.begin(), tree.special.end()));
    }
    clustering.clusters.pop_back();
    target.prepare(clustering, mesh);
    EXPECT_THROW(
        target.load(build_reference(tests::random_clusters(3, true, 1), mesh.bounds(), kSun)),
        std::invalid_argument);
}

/// Elements that a query at `point` meets on its way down the tree.
std::set<std::uint32_t> met_by_walk(const Tree& tree, const glm::dvec3& point) {
    const LightFrame& frame = tree.header.frame;
    const double depth = depth_of(frame, point);
    std::set<std::uint32_t> met;
    std::vector<std::uint32_t> links{tree.header.root};
    while (!links.empty()) {
        const std::uint32_t link = links.back();
        links.pop_back();
        if (link == 0) continue;
        const MetricNode& node = tree.nodes[link - 1];
        if (depth < node.min_depth) continue;
        const double d = distance_to(frame.directional != 0, seen(frame, point), element_of(node));
        if (d <= node.radius) met.insert(link - 1);
        if (d <= node.near_max) links.push_back(node.near);
        if (d >= node.far_min) links.push_back(node.far);
        if (d >= node.over_min && d <= node.over_max) links.push_back(node.over);
    }
    return met;
}

TEST_P(MetricBuild, QueriesMeetWhatBruteForceMeets) {
    const Clustering clustering = tests::random_clusters(2000, true, 51);
    for (const Light& light : {kOutside, kInside, kSun}) {
        const Tree tree = build(clustering, light);
        const LightFrame& frame = tree.header.frame;
        Random random(52);
        std::size_t met_count = 0;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 point = random.in_box(1.5);
            const std::set<std::uint32_t> met = met_by_walk(tree, point);
            for (std::uint32_t id = 0; id < clustering.clusters.size(); ++id) {
                Element element;
                double min_depth;
                if (make_element(frame, clustering.clusters[id], false, element, min_depth) !=
                    Role::element)
                    continue;
                const Element stored = element_of(tree.nodes[id]);
                const bool within = distance_to(frame.directional != 0, seen(frame, point),
                                                stored) <= stored.radius;
                const bool before = min_depth <= depth_of(frame, point);
                ASSERT_FALSE(within && before && !met.contains(id))
                    << "cluster " << id << " is not met at point " << i;
                ASSERT_FALSE(!within && met.contains(id));
                met_count += within && before ? 1 : 0;
            }
        }
        EXPECT_GT(met_count, 100u);
    }
}

using MetricRow = tests::GpuTest;

TEST_F(MetricRow, HasEveryBuilder) {
    const auto row =
        std::ranges::find(structures::registry(), "metric_tree", &structures::StructureRow::name);
    ASSERT_NE(row, structures::registry().end());
    const tests::TriangleMesh mesh = tests::sphere(40, 60, {1, -2, 3}, 5);
    for (const char* kind : {"insertion", "median", "cost", "cpu_median", "cpu_cost"})
        for (const bool directional : {false, true})
            for (const double height : {0.5, 2.0}) {
                SCOPED_TRACE(testing::Message() << kind << ", light at " << height);
                const auto settings =
                    structures::Settings::resolve(row->parameters(), {{"build", std::string(kind)},
                                                                      {"directional", directional},
                                                                      {"cull_facing", height > 1},
                                                                      {"light_x", 0.4},
                                                                      {"light_y", height}});
                const auto builder = row->create(tests::device(), settings);
                std::set<std::uint64_t> fingerprints;
                for (int i = 0; i < 2; ++i) {
                    builder->prepare(mesh);
                    pool::run(tests::device(), builder->job());
                    EXPECT_THAT(builder->validate(), testing::IsEmpty());
                    fingerprints.insert(builder->fingerprint());
                }
                EXPECT_EQ(fingerprints.size(), 1u);
                EXPECT_EQ(fingerprints.contains(0), std::string(kind) == "insertion");
            }
}

TEST_P(MetricBuild, TakesTheMemoryItSays) {
    const Clustering clustering = tests::random_clusters(5000, true, 3);
    const std::uint64_t before = tests::device().allocated_bytes();
    MetricTreeBuild target(tests::device(), {.builder = GetParam()});
    run(target, clustering, kOutside);
    EXPECT_LE(tests::device().allocated_bytes() - before, target.required_bytes(5000, 0) + 1024);
}

std::string name_of(const testing::TestParamInfo<BuilderKind>& info) {
    constexpr const char* kNames[]{"insertion", "median", "cost"};
    return kNames[static_cast<int>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Builders, MetricBuild,
                         testing::Values(BuilderKind::insertion, BuilderKind::median,
                                         BuilderKind::cost),
                         name_of);

}  // namespace
