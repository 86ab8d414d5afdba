// SAH cost and EPO against hand-made cases and against Monte Carlo.
#include <gtest/gtest.h>

#include "structures/bvh/epo.hpp"
#include "structures/bvh/quality.hpp"
#include "structures/bvh/reference.hpp"
#include "tests/structures/meshes.hpp"

namespace structures::bvh {
namespace {

using geometry::Aabb;
using geometry::TriangleMesh;

/// Two triangles of area 2 in the plane z = 0, the second shifted by (1, 0): in one leaf each.
struct TwoOverlapping {
    TriangleMesh mesh;
    Tree tree;
    TwoOverlapping() {
        tests::add_triangle(mesh, {0, 0, 0}, {2, 0, 0}, {0, 2, 0});
        tests::add_triangle(mesh, {1, 0, 0}, {3, 0, 0}, {1, 2, 0});
        tree.nodes = {{{0, 0, 0}, 1, {3, 2, 0}, 0},
                      {{0, 0, 0}, 0, {2, 2, 0}, 1},
                      {{1, 0, 0}, 1, {3, 2, 0}, 1}};
        tree.order = {0, 1};
    }
};

TEST(BvhQuality, SahCostByHand) {
    const TwoOverlapping two;
    const Quality quality = measure(two.mesh, two.tree);
    // Half areas: root 6, leaves 4 each.
    EXPECT_DOUBLE_EQ(quality.sah_cost, 3 + 2 * 4.0 / 6 + 2 * 4.0 / 6);
    EXPECT_DOUBLE_EQ(quality.sah_cost_compacted, 4);  // one leaf of two
    EXPECT_EQ(quality.nodes, 3u);
    EXPECT_EQ(quality.depth_max, 1u);
    EXPECT_DOUBLE_EQ(quality.depth_mean, 1);
    EXPECT_DOUBLE_EQ(quality.leaf_size_mean, 1);
    const Quality free_steps =
        measure(two.mesh, two.tree, {.costs = {.traversal = 0.5, .intersection = 2}});
    EXPECT_DOUBLE_EQ(free_steps.sah_cost_compacted, free_steps.sah_cost);
}

TEST(BvhQuality, EpoByHand) {
    const TwoOverlapping two;
    // Of the first triangle, x in [1, 2] lies in the second's leaf: area 1/2. Of the second, x in
    // [1, 2] lies in the first's: 2 - 1/2 = 3/2. Leaves cost 2; the scene's area is 4.
    EXPECT_DOUBLE_EQ(end_point_overlap(two.mesh, two.tree, {}), (2 * 0.5 + 2 * 1.5) / 4);
}

TEST(BvhQuality, EmptyAndSingle) {
    EXPECT_EQ(measure({}, build_reference({}, {})), Quality{});
    const TriangleMesh one = tests::random_triangles(1, 1);
    const Quality quality = measure(one, build_reference(one, {}));
    EXPECT_DOUBLE_EQ(quality.sah_cost, 2);
    EXPECT_EQ(quality.epo, 0);
    EXPECT_EQ(quality.nodes, 1u);
    EXPECT_EQ(quality.depth_max, 0u);
}

TEST(BvhQuality, ClippedArea) {
    const glm::dvec3 corners[3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    const auto area = [&](glm::vec3 lower, glm::vec3 upper) {
        return clipped_area(corners, Aabb{lower, upper});
    };
    EXPECT_DOUBLE_EQ(area({-1, -1, -1}, {3, 3, 3}), 2);
    EXPECT_DOUBLE_EQ(area({0, 0, 0}, {1, 1, 0}), 1);        // flat box in the triangle's plane
    EXPECT_DOUBLE_EQ(area({0.5, 0.5, 0}, {9, 9, 1}), 0.5);  // in the box's face
    EXPECT_DOUBLE_EQ(area({1, 1, -1}, {2, 2, 1}), 0);       // touches in a point
    EXPECT_DOUBLE_EQ(area({0, 0, 0.1f}, {2, 2, 1}), 0);
    const glm::dvec3 tilted[3] = {{-9, -9, -9}, {9, -9, 9}, {0, 9, 0}};
    EXPECT_GT(clipped_area(tilted, Aabb{{-1, -1, -1}, {1, 1, 1}}), 0);
}

TEST(BvhQuality, EpoAgreesWithMonteCarlo) {
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const TriangleMesh mesh = tests::random_triangles(60, seed, 0.4f);
        const Tree tree = build_reference(mesh, {.rule = SplitRule::object_median});
        // leaf_path[n]: the primitives below node n.
        std::vector<std::vector<bool>> below(tree.nodes.size(), std::vector<bool>(60));
        const auto collect = [&](auto&& self, std::uint32_t id) -> void {
            const BvhNode& node = tree.nodes[id];
            for (std::uint32_t i = 0; i < node.count; ++i)
                below[id][tree.order[node.first + i]] = true;
            if (node.count > 0) return;
            for (const std::uint32_t child : {node.first, node.first + 1}) {
                self(self, child);
                for (int i = 0; i < 60; ++i) below[id][i] = below[id][i] || below[child][i];
            }
        };
        collect(collect, 0);

        std::mt19937 random(seed);
        std::uniform_real_distribution<float> unit(0, 1);
        constexpr int kSamples = 4000;  // of each triangle
        double weighted = 0, total = 0;
        for (std::uint32_t id = 0; id < 60; ++id) {
            const glm::vec3 a = mesh.corner(id, 0), ab = mesh.corner(id, 1) - a,
                            ac = mesh.corner(id, 2) - a;
            const double area = 0.5 * glm::length(glm::cross(ab, ac));
            total += area;
            for (int sample = 0; sample < kSamples; ++sample) {
                float u = unit(random), v = unit(random);
                if (u + v > 1) u = 1 - u, v = 1 - v;
                const glm::vec3 p = a + u * ab + v * ac;
                for (std::uint32_t n = 0; n < tree.nodes.size(); ++n)
                    if (!below[n][id] && box_of(tree.nodes[n]).contains({p, p}))
                        weighted += area / kSamples *
                                    (tree.nodes[n].count ? 2.0 * tree.nodes[n].count : 3.0);
            }
        }
        const double expected = weighted / total;
        EXPECT_GT(expected, 0.1);
        EXPECT_NEAR(end_point_overlap(mesh, tree, {}), expected, 0.01 * expected);
    }
}

TEST(BvhQuality, SamplesCarryTheMetricNames) {
    const Samples samples = to_samples({.sah_cost = 5, .nodes = 3});
    ASSERT_EQ(samples.size(), 7u);
    EXPECT_EQ(samples.front().metric, "sah_cost");
    EXPECT_EQ(samples.front().value, 5);
    EXPECT_EQ(samples.back().metric, "nodes");
    EXPECT_EQ(samples.back().value, 3);
}

}  // namespace
}  // namespace structures::bvh
