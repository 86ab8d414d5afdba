// The validator finds every kind of damage, and only damage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "structures/bvh/reference.hpp"
#include "structures/bvh/validate.hpp"
#include "tests/structures/meshes.hpp"

namespace structures::bvh {
namespace {

using geometry::TriangleMesh;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class BvhValidate : public testing::Test {
  protected:
    BvhValidate() : mesh_(tests::random_triangles(200, 42)) {
        mesh_.triangles.push_back({0, 0, 1});  // degenerate: id 200
        tree_ = build_reference(mesh_, {});
        for (leaf_ = 0; tree_.nodes[leaf_].count < 2;) ++leaf_;
    }
    void expect_violation(const char* text, const Limits& limits = {}) {
        EXPECT_THAT(validate(mesh_, tree_, limits), Contains(HasSubstr(text)));
    }

    TriangleMesh mesh_;
    Tree tree_;
    std::uint32_t leaf_;  ///< one with at least two primitives
};

TEST_F(BvhValidate, SoundTreesPass) {
    EXPECT_THAT(validate(mesh_, tree_, {.max_leaf_size = 4, .max_depth = 64, .tight = true}),
                IsEmpty());
    EXPECT_THAT(validate({}, build_reference({}, {}), {}), IsEmpty());
}

TEST_F(BvhValidate, HolesAreFine) {
    const std::uint32_t pair = tree_.nodes[0].first;
    const auto far = static_cast<std::uint32_t>(tree_.nodes.size()) + 5;
    const BvhNode garbage{{1, 2, 3}, 77, {0, 0, 0}, 99};
    tree_.nodes.resize(far + 2, garbage);
    for (const std::uint32_t side : {0u, 1u})
        tree_.nodes[far + side] = std::exchange(tree_.nodes[pair + side], garbage);
    tree_.nodes[0].first = far;
    EXPECT_THAT(validate(mesh_, tree_, {.tight = true}), IsEmpty());
}

TEST_F(BvhValidate, FindsBrokenLinks) {
    const BvhNode root = tree_.nodes[0];
    tree_.nodes[0].first = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;
    expect_violation("not among nodes");
    tree_.nodes[0].first = 0xffffffffu;
    expect_violation("not among nodes");
    tree_.nodes[0] = root;
    tree_.nodes[leaf_].count = 0;
    tree_.nodes[leaf_].first = 0;
    expect_violation("not among nodes");
}

TEST_F(BvhValidate, FindsCyclesAndSharedSubtrees) {
    tree_.nodes[leaf_].count = 0;
    tree_.nodes[leaf_].first = tree_.nodes[0].first;
    expect_violation("a second time");
}

TEST_F(BvhValidate, FindsLeafRangesOutOfOrder) {
    tree_.nodes[leaf_].first = static_cast<std::uint32_t>(tree_.order.size()) - 1;
    expect_violation("exceeds the");
    tree_.nodes[leaf_].first = 0xffffffffu;
    expect_violation("exceeds the");
}

TEST_F(BvhValidate, FindsUnknownPrimitives) {
    tree_.order[tree_.nodes[leaf_].first] = 201;
    expect_violation("does not exist");
}

TEST_F(BvhValidate, FindsLostDoubledAndDegeneratePrimitives) {
    const std::uint32_t first = tree_.nodes[leaf_].first;
    const std::uint32_t lost = tree_.order[first];
    tree_.order[first] = tree_.order[first + 1];
    expect_violation("in 2 leaves");
    expect_violation(("primitive " + std::to_string(lost) + ": in 0 leaves").c_str());
    tree_.order[first] = 200;
    expect_violation("degenerate, yet in a leaf");
    tree_.order[first] = lost;
    tree_.order.push_back(0);
    expect_violation("order has 201 entries for 200");
}

TEST_F(BvhValidate, FindsBoxesThatAreTooSmall) {
    tree_.nodes[leaf_].upper.x = tree_.nodes[leaf_].lower.x;
    expect_violation("sticks out of the box");
    tree_.nodes[0].upper.y = 0.5f;
    expect_violation("node 0: the box of child");
    tree_.nodes[0].upper.y = NAN;
    expect_violation("node 0: the box of child");
}

TEST_F(BvhValidate, FindsLooseBoxesWhenAsked) {
    tree_.nodes[0].upper.y += 1;
    EXPECT_THAT(validate(mesh_, tree_, {}), IsEmpty());
    expect_violation("node 0: the box is not tight", {.tight = true});
}

TEST_F(BvhValidate, FindsExceededLimits) {
    expect_violation("primitives exceed 1", {.max_leaf_size = 1});
    expect_violation("exceeds 3", {.max_depth = 3});
}

TEST_F(BvhValidate, FindsWrongEmptyRoots) {
    tree_.nodes[0] = {{0, 0, 0}, 0, {1, 1, 1}, 0};
    expect_violation("its box is not empty");
    expect_violation("in 0 leaves");
    tree_.nodes.clear();
    expect_violation("no nodes");
}

TEST_F(BvhValidate, CountsWhatItDoesNotList) {
    tree_.order.clear();
    const std::vector<std::string> lines = validate(mesh_, tree_, {});
    EXPECT_EQ(lines.size(), 21u);
    EXPECT_THAT(lines.back(), HasSubstr("more violations"));
}

}  // namespace
}  // namespace structures::bvh
