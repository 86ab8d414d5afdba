#include "shadows/truth/candidates.hpp"

#include "structures/bvh/reference.hpp"

namespace shadows::truth {

using structures::bvh::BvhNode;
using structures::geometry::TriangleMesh;

Path::Path(const glm::dvec3& p, const glm::dvec3& towards, double length, double radius)
    : end(length) {
    const double grown = radius * (1 + 0x1p-20);
    for (int axis = 0; axis < 3; ++axis) {
        const bool down = towards[axis] < 0;
        inverse[axis] = towards[axis] == 0 ? 0x1p600 : 1 / towards[axis];
        enter[axis] = down ? p[axis] - grown : p[axis] + grown;
        leave[axis] = down ? p[axis] + grown : p[axis] - grown;
        backward[axis] = down;
    }
}

Candidates::Candidates(const TriangleMesh& mesh, std::span<const std::uint32_t> casters) {
    if (casters.empty()) return;
    TriangleMesh casting;
    casting.positions = mesh.positions;
    casting.triangles.reserve(casters.size());
    for (const std::uint32_t t : casters) casting.triangles.push_back(mesh.triangles[t]);
    structures::bvh::ReferenceConfig config;
    config.max_depth = kMaxDepth;
    structures::bvh::Tree tree = structures::bvh::build_reference(casting, config);

    order_.reserve(tree.order.size());
    for (const std::uint32_t i : tree.order) order_.push_back(casters[i]);

    // Each inner node takes in its children's boxes and links; a root that is a leaf becomes the
    // only child of a node of its own.
    std::vector<std::uint32_t> place(tree.nodes.size());
    std::uint32_t inner = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
        if (tree.nodes[i].count == 0) place[i] = inner++;
    const auto adopt = [&](Node& node, int child, const BvhNode& from) {
        for (int axis = 0; axis < 3; ++axis) {
            node.bounds[0][axis][child] = from.lower[axis];
            node.bounds[1][axis][child] = from.upper[axis];
        }
        node.first[child] = from.count == 0 ? place[&from - tree.nodes.data()] : from.first;
        node.count[child] = from.count;
    };
    if (inner == 0) {
        Node& root = nodes_.emplace_back();
        adopt(root, 0, tree.nodes[0]);
        adopt(root, 1, {glm::vec3(INFINITY), 0, glm::vec3(-INFINITY), 1});
        return;
    }
    for (const BvhNode& node : tree.nodes) {
        if (node.count > 0) continue;
        Node& made = nodes_.emplace_back();
        adopt(made, 0, tree.nodes[node.first]);
        adopt(made, 1, tree.nodes[node.first + 1]);
    }
}

}  // namespace shadows::truth
