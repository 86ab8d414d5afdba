#include "structures/bvh/validate.hpp"

#include "structures/violations.hpp"

namespace structures::bvh {
namespace {

using geometry::Aabb;

class Validator : Violations {
  public:
    Validator(const geometry::TriangleMesh& mesh, const Tree& tree, const Limits& limits)
        : mesh_(mesh), tree_(tree), limits_(limits) {}

    std::vector<std::string> run() {
        if (tree_.nodes.empty()) {
            fail("no nodes: even an empty tree has a root");
        } else if (tree_.empty()) {
            if (!box_of(tree_.nodes[0]).empty()) fail("empty root: its box is not empty");
        } else {
            check_nodes();
        }
        check_primitives();
        return take_lines();
    }

  private:
    void check_nodes() {
        const auto node_count = tree_.nodes.size();
        reached_.resize(node_count);
        leaf_uses_.resize(mesh_.triangle_count());
        reached_[0] = true;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};  // node, depth
        while (!stack.empty()) {
            const auto [id, depth] = stack.back();
            stack.pop_back();
            const BvhNode& node = tree_.nodes[id];
            if (node.count > 0) {
                check_leaf(id, depth);
                continue;
            }
            if (node.first == 0 || std::size_t{node.first} + 1 >= node_count) {
                fail("node {}: children {} and {} are not among nodes 1 to {}", id, node.first,
                     std::uint64_t{node.first} + 1, node_count - 1);
                continue;
            }
            Aabb held;
            for (const std::uint32_t child : {node.first + 1, node.first}) {
                const Aabb box = box_of(tree_.nodes[child]);
                held.grow(box);
                if (reached_[child]) {
                    fail("node {}: child {} is reached a second time", id, child);
                    continue;
                }
                reached_[child] = true;
                if (!box_of(node).contains(box))
                    fail("node {}: the box of child {} sticks out", id, child);
                stack.emplace_back(child, depth + 1);
            }
            if (limits_.tight && held != box_of(node)) fail("node {}: the box is not tight", id);
        }
    }

    void check_leaf(std::uint32_t id, std::uint32_t depth) {
        const BvhNode& leaf = tree_.nodes[id];
        if (depth > limits_.max_depth)
            fail("leaf {}: depth {} exceeds {}", id, depth, limits_.max_depth);
        if (leaf.count > limits_.max_leaf_size)
            fail("leaf {}: {} primitives exceed {}", id, leaf.count, limits_.max_leaf_size);
        const std::uint64_t end = std::uint64_t{leaf.first} + leaf.count;
        if (end > tree_.order.size()) {
            fail("leaf {}: range {} to {} exceeds the {} primitives in order", id, leaf.first, end,
                 tree_.order.size());
            return;
        }
        Aabb held;
        for (std::uint32_t i = leaf.first; i < end; ++i) {
            const std::uint32_t primitive = tree_.order[i];
            if (primitive >= mesh_.triangle_count()) {
                fail("leaf {}: primitive {} of {} does not exist", id, primitive,
                     mesh_.triangle_count());
                continue;
            }
            ++leaf_uses_[primitive];
            const Aabb bounds = mesh_.triangle_bounds(primitive);
            held.grow(bounds);
            if (!box_of(leaf).contains(bounds))
                fail("leaf {}: primitive {} sticks out of the box", id, primitive);
        }
        if (limits_.tight && held != box_of(leaf)) fail("leaf {}: the box is not tight", id);
    }

    void check_primitives() {
        leaf_uses_.resize(mesh_.triangle_count());
        std::size_t expected = 0;
        for (std::size_t primitive = 0; primitive < leaf_uses_.size(); ++primitive) {
            const bool degenerate = mesh_.degenerate(primitive);
            const std::uint32_t uses = leaf_uses_[primitive];
            expected += !degenerate;
            if (degenerate && uses > 0) fail("primitive {}: degenerate, yet in a leaf", primitive);
            if (!degenerate && uses != 1) fail("primitive {}: in {} leaves", primitive, uses);
        }
        if (tree_.order.size() != expected)
            fail("order has {} entries for {} non-degenerate primitives", tree_.order.size(),
                 expected);
    }

    const geometry::TriangleMesh& mesh_;
    const Tree& tree_;
    const Limits& limits_;
    std::vector<bool> reached_;             ///< by node
    std::vector<std::uint32_t> leaf_uses_;  ///< by primitive
};

}  // namespace

std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Tree& tree,
                                  const Limits& limits) {
    return Validator(mesh, tree, limits).run();
}

}  // namespace structures::bvh
