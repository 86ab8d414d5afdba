#include "structures/bvh/quality.hpp"

#include <algorithm>

#include "structures/bvh/epo.hpp"

namespace structures::bvh {

Quality measure(const geometry::TriangleMesh& mesh, const Tree& tree,
                const MeasureOptions& options) {
    Quality quality;
    if (tree.empty()) return quality;
    const double root_area = half_area(box_of(tree.nodes[0]));
    const CostModel& costs = options.costs;
    const auto hit_probability = [&](const BvhNode& node) {
        return root_area > 0 ? half_area(box_of(node)) / root_area : 0;
    };

    std::vector<std::uint32_t> preorder;
    double leaves = 0, depth_sum = 0, primitives = 0;
    walk(tree, [&](std::uint32_t id, std::uint32_t depth) {
        const BvhNode& node = tree.nodes[id];
        preorder.push_back(id);
        const double cost = node.count > 0 ? costs.intersection * node.count : costs.traversal;
        quality.sah_cost += cost * hit_probability(node);
        if (node.count == 0) return;
        leaves += 1;
        primitives += node.count;
        depth_sum += depth;
        quality.depth_max = std::max(quality.depth_max, depth);
    });
    quality.nodes = static_cast<std::uint32_t>(preorder.size());
    quality.depth_mean = depth_sum / leaves;
    quality.leaf_size_mean = primitives / leaves;

    // Bottom up: the cheaper of a subtree and of one leaf with all its primitives.
    struct Subtree {
        double cost = 0, primitives = 0;
    };
    std::vector<Subtree> subtrees(tree.nodes.size());
    for (auto it = preorder.rbegin(); it != preorder.rend(); ++it) {
        const BvhNode& node = tree.nodes[*it];
        const double probability = hit_probability(node);
        if (node.count > 0) {
            subtrees[*it] = {costs.intersection * node.count * probability, double(node.count)};
            continue;
        }
        const Subtree& left = subtrees[node.first];
        const Subtree& right = subtrees[node.first + 1];
        const double inside = left.primitives + right.primitives;
        subtrees[*it] = {std::min(costs.traversal * probability + left.cost + right.cost,
                                  costs.intersection * inside * probability),
                         inside};
    }
    quality.sah_cost_compacted = subtrees[0].cost;
    if (options.epo) quality.epo = end_point_overlap(mesh, tree, costs);
    return quality;
}

Samples to_samples(const Quality& quality) {
    return {{"sah_cost", quality.sah_cost},
            {"sah_cost_compacted", quality.sah_cost_compacted},
            {"epo", quality.epo},
            {"depth_max", double(quality.depth_max)},
            {"depth_mean", quality.depth_mean},
            {"leaf_size_mean", quality.leaf_size_mean},
            {"nodes", double(quality.nodes)}};
}

}  // namespace structures::bvh
