// The collapse of a binary BVH into 8-wide nodes: valid, within its bound, deterministic, and
// finished however deep the binary tree is.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "structures/bvh/reference.hpp"
#include "structures/bvh/wide/wide.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using structures::bvh::BvhNode;
using structures::bvh::Tree;
using structures::geometry::TriangleMesh;
using namespace structures::bvh::wide;
using WideBvh = tests::GpuTest;

TriangleMesh soup(std::uint32_t seed, std::size_t count, float size, glm::vec3 offset = {}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    TriangleMesh mesh;
    for (std::size_t t = 0; t < count; ++t) {
        const glm::vec3 at = offset + glm::vec3(unit(random), unit(random), unit(random));
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(at +
                                     size * glm::vec3(unit(random), unit(random), unit(random)));
        const auto first = static_cast<std::uint32_t>(3 * t);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

struct Built {
    WideHeader header;
    std::vector<WideChild> nodes;
    std::vector<structures::geometry::CornerTriangle> triangles;
    std::uint32_t launches = 1;
};

Built build(const TriangleMesh& mesh, const Tree& tree) {
    taskpool::gpu::Device& device = tests::device();
    using taskpool::gpu::make_buffer;
    const auto nodes = make_buffer<BvhNode>(device, tree.nodes, "nodes");
    const auto order = make_buffer<std::uint32_t>(device, tree.order, "order");
    const auto positions = make_buffer<glm::vec3>(device, mesh.positions, "positions");
    const auto corners = make_buffer<glm::uvec3>(device, mesh.triangles, "corners");
    const auto count = static_cast<std::uint32_t>(tree.order.size());
    const Capacity capacity{count, static_cast<std::uint32_t>(tree.nodes.size())};
    WideBuilder builder(device);
    builder.prepare(capacity);
    const BinaryTree binary{
        nodes.address(),   order.address(), positions.address(),
        corners.address(), count,           static_cast<std::uint32_t>(mesh.triangle_count())};
    Built built;
    {
        taskpool::gpu::Recorder recorder(device);
        builder.record(recorder, binary);
        device.run(recorder);
    }
    for (; builder.pending() > 0; ++built.launches) {
        taskpool::gpu::Recorder recorder(device);
        builder.record_rest(recorder, binary);
        device.run(recorder);
    }
    built.header = builder.header();
    built.nodes = builder.read_nodes();
    built.triangles = builder.read_triangles();
    EXPECT_LE(built.header.node_count, max_wide_nodes(capacity));
    const auto violations = validate(built.header, built.nodes, built.triangles, tree.order, mesh);
    for (const std::string& violation : violations) ADD_FAILURE() << violation;
    return built;
}

TEST_F(WideBvh, ValidForManySizes) {
    for (std::size_t count : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u, 20000u})
        for (auto rule :
             {structures::bvh::SplitRule::sweep_sah, structures::bvh::SplitRule::object_median}) {
            const TriangleMesh mesh = soup(5, count, 0.1f);
            for (std::uint32_t leaf : {1u, 4u, 100u})
                build(mesh, structures::bvh::build_reference(
                                mesh, {.rule = rule,
                                       .leaf_rule = structures::bvh::LeafRule::count,
                                       .max_leaf_size = leaf}));
        }
}

TEST_F(WideBvh, ValidAwayFromTheOriginAndFlat) {
    const TriangleMesh far = soup(6, 500, 1.0f, glm::vec3(1 << 20));
    build(far, structures::bvh::build_reference(far, {}));
    TriangleMesh flat = soup(7, 500, 0.1f);
    for (glm::vec3& p : flat.positions) p.y = 0.25f;
    build(flat, structures::bvh::build_reference(flat, {}));
    TriangleMesh huge = soup(8, 500, 0.1f);
    for (glm::vec3& p : huge.positions) p = (p - 0.5f) * 3e38f;
    build(huge, structures::bvh::build_reference(huge, {}));
}

TEST_F(WideBvh, LargeLeavesAreHalved) {
    TriangleMesh mesh = soup(9, 1, 1);
    mesh.triangles.resize(5000, mesh.triangles[0]);
    Tree tree;
    tree.nodes = {{mesh.bounds().lower, 0, mesh.bounds().upper, 5000}};
    for (std::uint32_t i = 0; i < 5000; ++i) tree.order.push_back(i);
    const Built built = build(mesh, tree);
    EXPECT_GT(built.header.node_count, 5000 / 8 / kMaxLeafCount);
}

TEST_F(WideBvh, DeepChainsTakeSeveralLaunches) {
    // Each inner node: one leaf and the rest of the chain.
    const std::uint32_t count = 1000;
    const TriangleMesh mesh = soup(10, count, 0.1f);
    Tree tree;
    tree.nodes.resize(2 * count - 1);
    for (std::uint32_t i = 0; i < count; ++i) tree.order.push_back(i);
    structures::geometry::Aabb box;
    for (std::uint32_t i = count; i-- > 0;) {
        // Node 2i holds triangles i and later; 2i - 1, its sibling, is the leaf of triangle i - 1.
        const structures::geometry::Aabb own = mesh.triangle_bounds(i);
        box.grow(own);
        if (i == count - 1)
            tree.nodes[2 * i] = {own.lower, i, own.upper, 1};
        else {
            tree.nodes[2 * i + 1] = {own.lower, i, own.upper, 1};
            tree.nodes[2 * i] = {box.lower, 2 * i + 1, box.upper, 0};
        }
    }
    const Built built = build(mesh, tree);
    EXPECT_GT(built.launches, 1u);
    EXPECT_GT(built.header.depth, WideBuilder::kLevels);
}

TEST_F(WideBvh, EqualTreesGiveEqualBytes) {
    const TriangleMesh mesh = soup(11, 30000, 0.02f);
    const Tree tree = structures::bvh::build_reference(mesh, {});
    const Built first = build(mesh, tree);
    for (int round = 0; round < 3; ++round) {
        const Built again = build(mesh, tree);
        ASSERT_EQ(first.nodes.size(), again.nodes.size());
        EXPECT_EQ(std::memcmp(first.nodes.data(), again.nodes.data(),
                              first.nodes.size() * sizeof(WideChild)),
                  0);
    }
}

TEST_F(WideBvh, TooManyTrianglesIsAnError) {
    WideBuilder builder(tests::device());
    EXPECT_THROW(builder.prepare({100'000'000, 200'000'000}), std::invalid_argument);
}

}  // namespace
