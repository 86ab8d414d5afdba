// The CPU builders: valid trees for every rule, size and degenerate input; the sweep is a sweep.
#include <gtest/gtest.h>

#include <cstring>

#include "structures/bvh/quality.hpp"
#include "structures/bvh/reference.hpp"
#include "structures/bvh/validate.hpp"
#include "tests/structures/meshes.hpp"

namespace structures::bvh {
namespace {

using geometry::Aabb;
using geometry::TriangleMesh;
using testing::Values;

Limits limits_of(const ReferenceConfig& config) {
    return {.max_leaf_size = config.max_leaf_size, .max_depth = config.max_depth, .tight = true};
}

void expect_valid(const TriangleMesh& mesh, const ReferenceConfig& config) {
    for (const std::string& violation :
         validate(mesh, build_reference(mesh, config), limits_of(config)))
        ADD_FAILURE() << violation;
}

bool equal(const Tree& a, const Tree& b) {
    return a.order == b.order && a.nodes.size() == b.nodes.size() &&
           std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)) == 0;
}

class EveryRule : public testing::TestWithParam<std::tuple<SplitRule, LeafRule>> {
  protected:
    ReferenceConfig config() const {
        ReferenceConfig config;
        std::tie(config.rule, config.leaf_rule) = GetParam();
        return config;
    }
};
INSTANTIATE_TEST_SUITE_P(Bvh, EveryRule,
                         testing::Combine(Values(SplitRule::sweep_sah, SplitRule::object_median,
                                                 SplitRule::spatial_median),
                                          Values(LeafRule::sah, LeafRule::count)));

TEST_P(EveryRule, SmallSizesAreValid) {
    for (const std::size_t count : {0, 1, 2, 3, 4, 5, 7, 8, 9, 31, 32, 33, 1000})
        for (const std::uint32_t leaf_size : {1u, 4u, 32u}) {
            SCOPED_TRACE(testing::Message() << count << " triangles, leaves of " << leaf_size);
            ReferenceConfig small = config();
            small.max_leaf_size = leaf_size;
            expect_valid(tests::random_triangles(count, 7 + static_cast<std::uint32_t>(count)),
                         small);
        }
}

TEST_P(EveryRule, IdenticalTrianglesStayShallow) {
    const TriangleMesh mesh = tests::identical_triangles(100000);
    const Tree tree = build_reference(mesh, config());
    EXPECT_TRUE(validate(mesh, tree, limits_of(config())).empty());
    EXPECT_LE(measure(mesh, tree, {.epo = false}).depth_max, 17u);
}

TEST_P(EveryRule, DepthIsBounded) {
    // Centres at geometrically shrinking distances make greedy splits peel off one at a time.
    TriangleMesh mesh;
    for (int i = 0; i < 400; ++i) {
        const float x = std::ldexp(1.0f, 100 - i / 2) * (1 + 0.5f * (i % 2));
        tests::add_triangle(mesh, {x, 0, 0}, {x * 1.1f, x * 0.1f, 0}, {x, 0, x * 0.1f});
    }
    ReferenceConfig bounded = config();
    for (const std::uint32_t depth : {9u, 12u, 64u}) {
        bounded.max_depth = depth;
        expect_valid(mesh, bounded);
    }
}

TEST_P(EveryRule, DegenerateTrianglesAreLeftOut) {
    const TriangleMesh mesh = tests::sphere(8, 9, {1, 2, 3}, 2);
    const Tree tree = build_reference(mesh, config());
    EXPECT_EQ(mesh.triangle_count() - tree.order.size(), 18u);
    EXPECT_TRUE(validate(mesh, tree, limits_of(config())).empty());
    TriangleMesh flat;
    flat.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    flat.triangles.assign(5, {0, 1, 2});
    EXPECT_TRUE(build_reference(flat, config()).empty());
    expect_valid(flat, config());
}

TEST_P(EveryRule, HugeAndTinyCoordinates) {
    for (const float scale : {1e38f, 1e-30f, 1e-38f}) {
        SCOPED_TRACE(scale);
        TriangleMesh mesh = tests::random_triangles(500, 3);
        for (glm::vec3& position : mesh.positions) position = position * scale;
        expect_valid(mesh, config());
    }
}

TEST_P(EveryRule, ThreadsDoNotMatter) {
    const TriangleMesh mesh = tests::random_triangles(20000, 11, 0.02f);
    ReferenceConfig one = config(), many = config();
    one.threads = 1;
    many.threads = 2;
    EXPECT_TRUE(equal(build_reference(mesh, one), build_reference(mesh, many)));
}

TEST(BvhReference, MillionTriangles) {
    const TriangleMesh mesh = tests::random_triangles(1000000, 5, 0.002f);
    expect_valid(mesh, {.rule = SplitRule::object_median, .leaf_rule = LeafRule::count});
    expect_valid(mesh, {.rule = SplitRule::spatial_median});
}

TEST(BvhReference, RejectsLeavesOfNothing) {
    EXPECT_THROW(build_reference({}, {.max_leaf_size = 0}), std::invalid_argument);
}

/// Cost A_l n_l + A_r n_r of the best cut of all primitives, by trying every one from scratch.
double best_cut(const TriangleMesh& mesh) {
    double best = INFINITY;
    std::vector<std::uint32_t> ids(mesh.triangle_count());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
        std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
            return mesh.triangle_bounds(a).center()[axis] < mesh.triangle_bounds(b).center()[axis];
        });
        for (std::size_t cut = 1; cut < ids.size(); ++cut) {
            Aabb left, right;
            for (std::size_t i = 0; i < cut; ++i) left.grow(mesh.triangle_bounds(ids[i]));
            for (std::size_t i = cut; i < ids.size(); ++i) right.grow(mesh.triangle_bounds(ids[i]));
            best = std::min(best, half_area(left) * cut + half_area(right) * (ids.size() - cut));
        }
    }
    return best;
}

std::size_t primitives_below(const Tree& tree, std::uint32_t id) {
    const BvhNode& node = tree.nodes[id];
    return node.count ? node.count
                      : primitives_below(tree, node.first) + primitives_below(tree, node.first + 1);
}

TEST(BvhReference, SweepTakesTheBestOfAllCuts) {
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const TriangleMesh mesh = tests::random_triangles(2 + seed, seed, 0.3f);
        const Tree tree = build_reference(mesh, {.leaf_rule = LeafRule::count, .max_leaf_size = 1});
        const std::uint32_t left = tree.nodes[0].first;
        double cost = 0;
        for (const std::uint32_t child : {left, left + 1})
            cost += half_area(box_of(tree.nodes[child])) * primitives_below(tree, child);
        EXPECT_NEAR(cost, best_cut(mesh), 1e-12 * cost);
    }
}

TEST(BvhReference, SahLeavesAreThoseThatDoNotPay) {
    // Two far triangles are worth separating, two coincident ones are not.
    TriangleMesh far = tests::identical_triangles(2);
    for (int k = 0; k < 3; ++k) far.positions.push_back(far.positions[k] + glm::vec3(100, 0, 0));
    far.triangles[1] = {3, 4, 5};
    // c_I n = 4 against 3 + 2 (A_l + A_r) / A, where A_l = A_r = 3 and A = 101 + 101 + 1.
    EXPECT_EQ(build_reference(far, {}).nodes.size(), 3u);
    EXPECT_EQ(build_reference(tests::identical_triangles(2), {}).nodes.size(), 1u);
    EXPECT_EQ(build_reference(far, {.costs = {.traversal = 4, .intersection = 2}}).nodes.size(),
              1u);
    EXPECT_EQ(build_reference(far, {.leaf_rule = LeafRule::count}).nodes.size(), 1u);

    const TriangleMesh mesh = tests::random_triangles(3000, 17);
    const Tree tree = build_reference(mesh, {});
    walk(tree, [&](std::uint32_t id, std::uint32_t) {
        const BvhNode& node = tree.nodes[id];
        const double count = static_cast<double>(primitives_below(tree, id));
        if (node.count > 0 || count > 4) return;
        double split_cost = 3;
        for (const std::uint32_t child : {node.first, node.first + 1})
            split_cost += 2 * half_area(box_of(tree.nodes[child])) / half_area(box_of(node)) *
                          static_cast<double>(primitives_below(tree, child));
        EXPECT_GT(2 * count, split_cost);
    });
}

TEST(BvhReference, SweepBeatsTheMedians) {
    TriangleMesh mesh = tests::sphere(40, 40, {0, 0, 0}, 1);
    const TriangleMesh clutter = tests::random_triangles(3000, 23, 0.01f);
    for (const glm::uvec3& t : clutter.triangles)
        tests::add_triangle(mesh, clutter.positions[t.x] * 9.0f, clutter.positions[t.y] * 9.0f,
                            clutter.positions[t.z] * 9.0f);
    const auto cost = [&](SplitRule rule) {
        return measure(mesh, build_reference(mesh, {.rule = rule}), {.epo = false}).sah_cost;
    };
    EXPECT_LT(cost(SplitRule::sweep_sah), cost(SplitRule::object_median));
    EXPECT_LT(cost(SplitRule::sweep_sah), cost(SplitRule::spatial_median));
}

}  // namespace
}  // namespace structures::bvh
