// Metric trees built by insertion: valid whatever the order, the pool, the light and the clusters.
#include <gmock/gmock.h>

#include <set>

#include "structures/metric_tree/build.hpp"
#include "structures/metric_tree/metric.hpp"
#include "tests/structures/metric_scenes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace structures::metric_tree {
namespace {

using namespace taskpool;
using geometry::Light;
using tests::MetricScene;
using tests::random_clusters;

constexpr Light kAbove{Light::Type::point, {0.5f, 2, 0.5f}};
constexpr Light kInside{Light::Type::point, {0.4f, 0.5f, 0.6f}};
constexpr Light kFar{Light::Type::point, {3000, 10'000, -2000}};
constexpr Light kSun{Light::Type::directional, {0.3f, -1, 0.2f}};

class MetricInsertion : public tests::GpuTest {
  protected:
    static Tree build(const MetricScene& scene, const Light& light,
                      const BuildConfig& config = {}) {
        MetricTreeBuild build(tests::device(), config);
        return run(build, scene, light);
    }
    static Tree run(MetricTreeBuild& build, const MetricScene& scene, const Light& light) {
        build.prepare(scene.clustering, scene.mesh);
        build.set_light(light);
        pool::run(tests::device(), build);
        return build.read_back();
    }
    static void expect_valid(const MetricScene& scene, const Tree& tree) {
        EXPECT_THAT(validate(scene.clustering, tree), testing::IsEmpty());
        const MetricHeader& header = tree.header;
        EXPECT_EQ(header.inserted + header.special_count + header.culled_facing,
                  scene.clustering.clusters.size());
        EXPECT_LE(header.depth_max, kMaxDepth);
    }
};

TEST_F(MetricInsertion, IsValidForAllSizesAndLights) {
    const std::uint32_t lanes = tests::device().subgroup_size();
    MetricTreeBuild build(tests::device(), {});
    for (const std::uint32_t count :
         std::set<std::uint32_t>{0, 1, 2, lanes - 1, lanes, lanes + 1, 1000})
        for (const double capsules : {0.0, 0.3, 1.0})
            for (const Light& light : {kAbove, kInside, kFar, kSun}) {
                const std::uint32_t seed = 7 + count;
                const MetricScene scene = random_clusters(count, seed, capsules);
                SCOPED_TRACE(testing::Message()
                             << count << " clusters, seed " << seed << ", " << capsules
                             << " capsules, light at " << light.vector.x);
                expect_valid(scene, run(build, scene, light));
            }
}

TEST_F(MetricInsertion, IsValidForManyClusters) {
    const MetricScene scene = random_clusters(100'000, 11, 0.2, 0.004f, 0.05f);
    for (const Light& light : {kAbove, kInside, kSun}) {
        const Tree tree = build(scene, light);
        expect_valid(scene, tree);
        EXPECT_EQ(tree.header.bucketed, 0u);
    }
}

}  // namespace
}  // namespace structures::metric_tree
