// Turns a binary BVH on the device into the 8-wide BVH that shadow queries walk.
//
//     WideBuilder builder(device);
//     builder.prepare({.triangles = n, .nodes = node_capacity});      // allocates
//     builder.record(recorder, {nodes.address(), order.address(), ...});
//     device.run(recorder);
//     while (builder.pending()) { Recorder r(device); builder.record_rest(r); device.run(r); }
//     query.record(recorder, builder.tree(), ...);
//
// The collapse opens the largest child first, level by level with indirect dispatches (open,
// number, link). Nodes are numbered in the order of their parents: equal trees give equal nodes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "structures/bvh/wide/wide_shared.h"
#include "structures/geometry/gather_triangles.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/gpu/recorder.hpp"

namespace structures::bvh::wide {

/// Upper bounds known before the build.
struct Capacity {
    std::uint32_t triangles = 0;  ///< primitives in the binary tree's leaves
    std::uint32_t nodes = 0;      ///< nodes of the binary tree that can be reached
};

/// Device addresses of a binary tree (bvh_shared.h) and of the mesh it was built over.
struct BinaryTree {
    std::uint64_t nodes = 0;      ///< BvhNode[]
    std::uint64_t order = 0;      ///< primitive ids in leaf order
    std::uint64_t positions = 0;  ///< vec3[]
    std::uint64_t corners = 0;    ///< uvec3[], one per primitive
    std::uint32_t order_count = 0;
    std::uint32_t primitive_count = 0;
};

/// Device addresses of a finished wide tree.
struct WideTree {
    std::uint64_t header = 0, nodes = 0, triangles = 0;
};

/// At most this many wide nodes come out of the binary tree. Every wide node with an inner child is
/// full: with F of those, B others (two children or more), and L leaves, counting children gives
/// 8F + 2B <= L + F + B - 1, and B <= 7F + 1 slots can hold the others; so F + B <= (4L + 6) / 7.
/// L counts leaves after those above kMaxLeafCount triangles are halved until they fit.
std::uint64_t max_wide_nodes(const Capacity& capacity);

class WideBuilder {
  public:
    explicit WideBuilder(taskpool::gpu::Device& device);

    /// Bytes prepare() allocates: the tree, and what only its construction needs.
    static std::size_t tree_bytes(const Capacity& capacity);
    static std::size_t scratch_bytes(const Capacity& capacity);

    /// Throws std::invalid_argument if a mesh of that size may need more than kMaxNodes nodes.
    void prepare(const Capacity& capacity);
    /// Records the whole build, for trees of up to kLevels levels of wide nodes.
    void record(taskpool::gpu::Recorder& recorder, const BinaryTree& binary);
    /// Nodes that a recorded and finished build has not reached yet: 0 unless the binary tree is
    /// extremely deep. Then record_rest() and run again, until it is 0.
    std::uint32_t pending() const;
    void record_rest(taskpool::gpu::Recorder& recorder, const BinaryTree& binary);

    WideTree tree() const;
    WideHeader header() const;
    /// Levels of one recording. A tree over n triangles has about log_6(n) of them.
    static constexpr std::uint32_t kLevels = 24;

    /// The finished tree, read back.
    std::vector<WideChild> read_nodes() const;
    std::vector<geometry::CornerTriangle> read_triangles() const;

  private:
    void record_levels(taskpool::gpu::Recorder& recorder, const BinaryTree& binary);

    taskpool::gpu::Device& device_;
    taskpool::gpu::Kernel begin_, open_, number_, link_;
    geometry::GatherTriangles gather_;
    taskpool::gpu::Buffer header_, nodes_, triangles_, items_, levels_, chunks_;
    std::uint32_t order_count_ = 0;
};

/// Checks a wide tree read back against the binary tree's leaf order: every triangle of `order` in
/// exactly one leaf, every node reached once, children inside their boxes, empty slots last. One
/// line per violation.
std::vector<std::string> validate(const WideHeader& header, const std::vector<WideChild>& nodes,
                                  const std::vector<geometry::CornerTriangle>& triangles,
                                  const std::vector<std::uint32_t>& order,
                                  const geometry::TriangleMesh& mesh);

}  // namespace structures::bvh::wide
