// Reference trees: valid, complete for queries, and of bounded depth whatever the clusters.
#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <limits>

#include "structures/metric_tree/reference.hpp"
#include "tests/structures/clusters.hpp"

namespace {

using namespace structures::metric_tree;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::Clustering;
using tests::Light;
using tests::Random;

constexpr Light kOutside{Light::Type::point, {0.3f, 4, 0.2f}};
constexpr Light kInside{Light::Type::point, {0.1f, 0.2f, -0.1f}};
constexpr Light kSun{Light::Type::directional, {1, -3, 0.5f}};

Tree build(const Clustering& clustering, const Light& light, Split split = Split::median,
           bool cull_facing = false) {
    return build_reference(clustering, tests::bounds_of(clustering), light,
                           {.split = split, .cull_facing = cull_facing});
}

/// Nodes that a query at `point` looks at, by the rules of metric_tree_shared.h; its distances err
/// as much as they may, either way.
std::vector<bool> nodes_visited(const Tree& tree, const glm::dvec3& point, Random& random) {
    const LightFrame& frame = tree.header.frame;
    const bool directional = frame.directional != 0;
    const double depth = depth_of(frame, point);
    const glm::dvec3 place = seen(frame, point);
    std::vector<bool> visited(tree.nodes.size());
    std::vector<std::uint32_t> stack;
    const auto push = [&](std::uint32_t link) {
        if (link != 0) stack.push_back(link - 1);
    };
    push(tree.header.root);
    while (!stack.empty()) {
        const std::uint32_t id = stack.back();
        stack.pop_back();
        const MetricNode& node = tree.nodes[id];
        if (depth < node.min_depth) continue;
        visited[id] = true;
        const double d = std::max(distance_to(directional, place, element_of(node)) +
                                      (random.below(2) == 0 ? -0.25 : 0.25) * kMetricError,
                                  0.0);
        if (d <= node.near_max) push(node.near);
        if (d >= node.far_min) push(node.far);
        if (d >= node.over_min && d <= node.over_max) push(node.over);
    }
    return visited;
}

/// Points anywhere, and points that some cluster is in front of; returns how many clusters are.
std::size_t expect_found(const Clustering& clustering, const Tree& tree, const Light& light,
                         int points) {
    Random random(99);
    const LightFrame& frame = tree.header.frame;
    std::size_t found = 0;
    for (int i = 0; i < points; ++i) {
        glm::dvec3 point = random.in_box(1.5);
        if (i % 2 == 0 && !clustering.clusters.empty()) {
            const Cluster& front = clustering.clusters[random.below(clustering.clusters.size())];
            point = glm::mix(glm::dvec3(front.a), glm::dvec3(front.b), random.uniform(0, 1)) +
                    random.direction() * double{front.radius};
            const double t = random.uniform(0, 1);
            point += t * (light.type == Light::Type::point ? point - glm::dvec3(light.vector)
                                                           : glm::dvec3(light.vector));
        }
        const double depth = depth_of(frame, point);
        const auto visited = nodes_visited(tree, point, random);
        for (std::uint32_t id = 0; id < clustering.clusters.size(); ++id) {
            Element element;
            double min_depth;
            if (make_element(frame, clustering.clusters[id], false, element, min_depth) !=
                Role::element)
                continue;
            if (distance_to(frame.directional != 0, seen(frame, point), element) <=
                    element.radius &&
                min_depth <= depth) {
                ++found;
                EXPECT_TRUE(visited[id]) << "cluster " << id << ", point " << i;
            }
        }
    }
    return found;
}

using Parameters = std::tuple<std::size_t, bool, Split>;
class ReferenceTree : public testing::TestWithParam<Parameters> {};

TEST_P(ReferenceTree, IsValidAndMissesNoCluster) {
    const auto [count, capsules, split] = GetParam();
    const Clustering clustering = tests::random_clusters(count, capsules, 7 + count);
    for (const Light& light : {kOutside, kInside, kSun}) {
        const Tree tree = build(clustering, light, split);
        EXPECT_THAT(validate(clustering, tree), IsEmpty());
        const TreeQuality quality = measure(tree);
        EXPECT_EQ(quality.nodes + tree.special.size(), count);
        EXPECT_LE(quality.depth_max, 60);
        const std::size_t found = expect_found(clustering, tree, light, 60);
        if (count > 0) {
            EXPECT_GE(found, 10u);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReferenceTree,
                         testing::Combine(testing::Values(0, 1, 2, 3, 100, 10'000), testing::Bool(),
                                          testing::Values(Split::median, Split::cost)));

TEST(ReferenceTrees, AreTheSameWhateverTheThreads) {
    const Clustering clustering = tests::random_clusters(5000, true, 3);
    for (const Split split : {Split::median, Split::cost}) {
        const Tree one = build(clustering, kOutside, split),
                   two = build(clustering, kOutside, split);
        ASSERT_EQ(
            std::memcmp(one.nodes.data(), two.nodes.data(), one.nodes.size() * sizeof(MetricNode)),
            0);
        EXPECT_EQ(one.header.root, two.header.root);
    }
}

TEST(ReferenceTrees, DuplicatesBecomeOneList) {
    Clustering clustering = tests::random_clusters(1, false, 1);
    clustering.clusters.resize(100'000, clustering.clusters[0]);
    for (const Split split : {Split::median, Split::cost}) {
        const Tree tree = build(clustering, kOutside, split);
        EXPECT_THAT(validate(clustering, tree), IsEmpty());
        EXPECT_EQ(tree.header.bucketed, 100'000u);
        EXPECT_EQ(tree.header.depth_max, 0u);
        EXPECT_EQ(measure(tree).depth_max, 100'000u);
    }
}

TEST(ReferenceTrees, DuplicatesAmongOthers) {
    Clustering clustering = tests::random_clusters(2000, true, 1);
    clustering.clusters.resize(4000, clustering.clusters[17]);
    for (const Light& light : {kOutside, kSun}) {
        const Tree tree = build(clustering, light);
        EXPECT_THAT(validate(clustering, tree), IsEmpty());
        EXPECT_GE(tree.header.bucketed, 2000u);
        expect_found(clustering, tree, light, 40);
    }
}

TEST(ReferenceTrees, CoaxialClusters) {
    Clustering clustering;
    for (int i = 0; i < 10'000; ++i)
        clustering.clusters.push_back(
            tests::make_cluster({0, 0, -5 - 0.05 * i}, {0, 0, -5 - 0.05 * i}, 0.5));
    for (const Light& light :
         {Light{Light::Type::point, {}}, Light{Light::Type::directional, {0, 0, -1}}}) {
        const Tree tree = build(clustering, light);
        EXPECT_THAT(validate(clustering, tree), IsEmpty());
        Random random(1);
        const auto before = nodes_visited(tree, {0, 0, -4.4}, random);
        EXPECT_EQ(std::count(before.begin(), before.end(), true), 0);
        const auto amid = nodes_visited(tree, {0, 0, -20}, random);
        EXPECT_LE(std::count(amid.begin(), amid.end(), true), 320);
        expect_found(clustering, tree, light, 40);
    }
}

TEST(ReferenceTrees, ClustersAroundTheLightAreSpecial) {
    Clustering clustering = tests::random_clusters(300, true, 5);
    const glm::dvec3 at = kInside.vector;
    clustering.clusters[7] = tests::make_cluster(at, at, 0.2);
    clustering.clusters[8] = tests::make_cluster(at + glm::dvec3(0.1, 0, 0), {1, 1, 1}, 0.11);
    clustering.clusters[9] = tests::make_cluster({-10, -.05, 0}, {10, -.05, 0}, 0.01);
    const Tree tree = build(clustering, kInside);
    for (const std::uint32_t id : {7u, 8u, 9u}) EXPECT_THAT(tree.special, testing::Contains(id));
    EXPECT_THAT(validate(clustering, tree), IsEmpty());
    expect_found(clustering, tree, kInside, 40);
}

TEST(ReferenceTrees, OnlyClustersThatFaceAwayAreLeftOut) {
    Clustering clustering = tests::random_clusters(2000, true, 5);
    Random random(2);
    for (Cluster& cluster : clustering.clusters) {
        cluster.axis = random.direction();
        cluster.cone_cosine = static_cast<float>(random.uniform(-0.2, 1));
    }
    for (const Light& light : {kOutside, kInside, kSun}) {
        EXPECT_EQ(build(clustering, light).header.culled_facing, 0u);
        Tree tree = build(clustering, light, Split::median, true);
        EXPECT_GE(tree.header.culled_facing, 100u);
        EXPECT_LE(tree.header.culled_facing, 1000u);
        EXPECT_THAT(validate(clustering, tree), IsEmpty());
        Clustering turned = clustering;
        for (Cluster& cluster : turned.clusters) cluster.axis = -cluster.axis;
        EXPECT_THAT(validate(turned, tree), testing::Contains(HasSubstr("does not face away")));
    }
}

class Faults : public testing::TestWithParam<Split> {
  protected:
    /// The fault's line must be among the first.
    void expect_fault(const Tree& tree, const char* says) {
        EXPECT_THAT(validate(clustering_, tree), testing::Contains(HasSubstr(says)));
    }
    std::uint32_t node_with(const std::function<bool(const MetricNode&)>& wanted) {
        for (std::uint32_t id = 0; id < good_.nodes.size(); ++id)
            if (wanted(good_.nodes[id])) return id;
        throw std::logic_error("no such node");
    }

    Clustering clustering_ = tests::random_clusters(1000, true, 11);
    Tree good_ = build(clustering_, kOutside, GetParam());
};

TEST_P(Faults, InLinks) {
    ASSERT_THAT(validate(clustering_, good_), IsEmpty());
    const std::uint32_t root = good_.header.root - 1;
    const std::uint32_t inner = node_with([](const MetricNode& n) { return n.near && n.far; });
    Tree bad = good_;
    bad.nodes[inner].near = 5000;
    expect_fault(bad, "link 5000 is none");
    bad = good_;
    bad.nodes[inner].near = 0xffffffffu;
    expect_fault(bad, "is none");
    bad = good_;
    bad.nodes[inner].near = root + 1;  // a loop
    expect_fault(bad, "linked already");
    bad = good_;
    bad.nodes[inner].far = bad.nodes[inner].near;
    expect_fault(bad, "linked already");
    bad = good_;
    bad.nodes[inner].near = 0;
    expect_fault(bad, "is not linked");
    bad = good_;
    bad.header.root = 0;
    expect_fault(bad, "is not linked");
    bad = good_;
    bad.nodes[inner].ancestor ^= 1;
    expect_fault(bad, "ancestor");
    bad = good_;
    bad.nodes.pop_back();
    expect_fault(bad, "999 nodes for 1000 clusters");
    bad = good_;
    bad.special = {3, 3, 2000};
    expect_fault(bad, "cluster 3 is both special and linked");
    expect_fault(bad, "cluster 3 is listed as special twice");
    expect_fault(bad, "special cluster 2000 is none");
    bad = good_;
    ++bad.header.depth_max;
    expect_fault(bad, "depth_max");
}

TEST_P(Faults, InBounds) {
    const auto spoil = [&](std::uint32_t id, auto change, const char* says) {
        Tree bad = good_;
        change(bad.nodes[id]);
        expect_fault(bad, says);
    };
    const std::uint32_t near = node_with([](const MetricNode& n) { return n.near != 0; });
    const std::uint32_t far = node_with([](const MetricNode& n) { return n.far != 0; });
    const std::uint32_t over = node_with([](const MetricNode& n) { return n.over != 0; });
    spoil(
        near, [](MetricNode& n) { n.near_max *= 0.8f; }, "in its near subtree");
    spoil(
        far, [](MetricNode& n) { n.far_min *= 1.2f; }, "in its far subtree");
    spoil(
        over, [](MetricNode& n) { n.over_max *= 0.8f; }, "in its over subtree");
    spoil(
        over, [](MetricNode& n) { n.over_min = n.over_min * 1.1f + 0.01f; }, "in its over subtree");
    spoil(
        far, [](MetricNode& n) { n.min_depth += 0.01f; }, "min_depth");
    spoil(
        far, [](MetricNode& n) { n.radius *= 0.99f; }, "past the radius");
    spoil(
        far, [](MetricNode& n) { n.a.x += 1e-3f, n.b.x += 1e-3f; }, "past the radius");
    spoil(
        far, [](MetricNode& n) { n.far_min = std::numeric_limits<float>::quiet_NaN(); },
        "in its far subtree");
}

TEST_P(Faults, AnyBytesAreSurvived) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 50; ++trial) {
        Tree bad = good_;
        for (int k = 0; k < 30; ++k) {
            auto* words = reinterpret_cast<std::uint32_t*>(bad.nodes.data());
            words[random() % (bad.nodes.size() * 16)] = random() >> random() % 32;
        }
        measure(bad);
        validate(clustering_, bad);
        auto* words = reinterpret_cast<std::uint32_t*>(&bad.header);
        for (int k = 0; k < 24; ++k) words[k] = random();
        measure(bad);
        EXPECT_FALSE(validate(clustering_, bad).empty());
    }
}

INSTANTIATE_TEST_SUITE_P(Splits, Faults, testing::Values(Split::median, Split::cost));

}  // namespace
