// The CPU builders; reference.hpp describes the method.
#include "structures/bvh/reference.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>

namespace structures::bvh {
namespace {

using geometry::Aabb;

/// Below this many primitives a subtree is built by one thread.
constexpr std::uint32_t kSerialRange = 4096;

/// The range [begin, end) is cut before `position` of the list sorted along `axis`; `cost` is
/// A_l n_l + A_r n_r.
struct Split {
    int axis = 0;
    std::uint32_t position = 0;
    double cost = std::numeric_limits<double>::infinity();
};

class Build {
  public:
    Build(const geometry::TriangleMesh& mesh, const ReferenceConfig& config) : config_(config) {
        const auto triangle_count = static_cast<std::uint32_t>(mesh.triangle_count());
        boxes_.resize(triangle_count);
        for (std::uint32_t id = 0; id < triangle_count; ++id) {
            if (mesh.degenerate(id)) continue;
            boxes_[id] = mesh.triangle_bounds(id);
            lists_[0].push_back(id);
        }
        lists_[1] = lists_[2] = lists_[0];
        scratch_.resize(lists_[0].size());
        right_areas_.resize(lists_[0].size());
        on_left_.resize(triangle_count);
    }

    Tree run() {
        const auto count = static_cast<std::uint32_t>(lists_[0].size());
        if (count == 0) {
            const Aabb nothing;
            return {{{nothing.lower, 0, nothing.upper, 0}}, {}};
        }
        tbb::parallel_for(0, 3, [&](int axis) {
            std::sort(lists_[axis].begin(), lists_[axis].end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          const float ca = center(a, axis), cb = center(b, axis);
                          return ca != cb ? ca < cb : a < b;
                      });
        });
        // A range of n primitives is cut n - 1 times at most, each time at another position: the
        // children of the cut at p are nodes 2p - 1 and 2p, so threads need no common counter.
        nodes_.resize(2 * std::size_t{count} - 1);
        subtree(0, 0, count, 0);
        return {dense_nodes(), std::move(lists_[0])};
    }

  private:
    float center(std::uint32_t id, int axis) const { return boxes_[id].center()[axis]; }

    void subtree(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::uint32_t depth) {
        Aabb box, centers;
        for (std::uint32_t i = begin; i < end; ++i) {
            box.grow(boxes_[lists_[0][i]]);
            centers.grow(boxes_[lists_[0][i]].center());
        }
        const std::uint32_t count = end - begin;
        nodes_[node] = {box.lower, begin, box.upper, count};
        if (count == 1) return;
        if (config_.leaf_rule == LeafRule::count && count <= config_.max_leaf_size) return;
        const Split split = choose(begin, end, depth, centers);
        if (count <= config_.max_leaf_size && !pays(split, half_area(box), count)) return;
        partition(split, begin, end);

        const std::uint32_t left = 2 * split.position - 1;
        nodes_[node].first = left;
        nodes_[node].count = 0;
        const auto build_left = [&] { subtree(left, begin, split.position, depth + 1); };
        const auto build_right = [&] { subtree(left + 1, split.position, end, depth + 1); };
        if (count > kSerialRange) {
            tbb::parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

    /// Whether splitting is expected to cost less than a leaf: c_I n > c_T + c_I cost / A.
    bool pays(const Split& split, double area, std::uint32_t count) const {
        if (!(area > 0)) return false;
        const CostModel& c = config_.costs;
        return c.intersection * count > c.traversal + c.intersection * split.cost / area;
    }

    Split choose(std::uint32_t begin, std::uint32_t end, std::uint32_t depth, const Aabb& centers) {
        const glm::vec3 extent = centers.extent();
        const int longest = extent.x >= extent.y && extent.x >= extent.z ? 0
                            : extent.y >= extent.z                       ? 1
                                                                         : 2;
        const std::uint32_t middle = begin + (end - begin) / 2;
        // Halving n primitives down to single ones takes bit_width(n - 1) levels.
        const auto levels_needed = static_cast<std::uint32_t>(std::bit_width(end - begin - 1));
        const bool must_halve = depth + levels_needed >= config_.max_depth;
        if (must_halve || extent[longest] == 0 || config_.rule == SplitRule::object_median)
            return at(longest, middle, begin, end);
        if (config_.rule == SplitRule::spatial_median) {
            const float plane = centers.center()[longest];
            const auto first = lists_[longest].begin();
            const auto cut =
                std::partition_point(first + begin, first + end,
                                     [&](std::uint32_t id) { return center(id, longest) < plane; });
            const auto position = static_cast<std::uint32_t>(cut - first);
            return at(longest, position > begin ? position : middle, begin, end);
        }
        return sweep(begin, end);
    }

    Split at(int axis, std::uint32_t position, std::uint32_t begin, std::uint32_t end) const {
        Aabb left, right;
        for (std::uint32_t i = begin; i < position; ++i) left.grow(boxes_[lists_[axis][i]]);
        for (std::uint32_t i = position; i < end; ++i) right.grow(boxes_[lists_[axis][i]]);
        return {axis, position,
                half_area(left) * (position - begin) + half_area(right) * (end - position)};
    }

    /// The cheapest of all positions; of equally cheap ones the most even, which halves a range of
    /// identical primitives instead of peeling them off one by one.
    Split sweep(std::uint32_t begin, std::uint32_t end) {
        Split best;
        std::uint32_t best_imbalance = 0;
        for (int axis = 0; axis < 3; ++axis) {
            Aabb right;
            for (std::uint32_t i = end - 1; i > begin; --i) {
                right.grow(boxes_[lists_[axis][i]]);
                right_areas_[i] = half_area(right);
            }
            Aabb left;
            for (std::uint32_t i = begin + 1; i < end; ++i) {
                left.grow(boxes_[lists_[axis][i - 1]]);
                const double cost = half_area(left) * (i - begin) + right_areas_[i] * (end - i);
                const std::uint32_t imbalance =
                    i - begin > end - i ? 2 * i - begin - end : begin + end - 2 * i;
                if (cost < best.cost || (cost == best.cost && imbalance < best_imbalance)) {
                    best = {axis, i, cost};
                    best_imbalance = imbalance;
                }
            }
        }
        return best;
    }

    /// Brings the left primitives of the split to the front of all three lists, each still sorted.
    void partition(const Split& split, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
            on_left_[lists_[split.axis][i]] = i < split.position;
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == split.axis) continue;
            std::vector<std::uint32_t>& list = lists_[axis];
            std::uint32_t left = begin, right = split.position;
            for (std::uint32_t i = begin; i < end; ++i)
                scratch_[on_left_[list[i]] ? left++ : right++] = list[i];
            std::copy(scratch_.begin() + begin, scratch_.begin() + end, list.begin() + begin);
        }
    }

    /// The reached nodes without the holes that positions inside leaves left.
    std::vector<BvhNode> dense_nodes() const {
        std::vector<BvhNode> dense{nodes_[0]};
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const std::uint32_t parent = stack.back();
            stack.pop_back();
            if (dense[parent].count > 0) continue;
            const std::uint32_t old_pair = dense[parent].first;
            const auto pair = static_cast<std::uint32_t>(dense.size());
            dense[parent].first = pair;
            dense.push_back(nodes_[old_pair]);
            dense.push_back(nodes_[old_pair + 1]);
            stack.push_back(pair + 1);
            stack.push_back(pair);
        }
        return dense;
    }

    const ReferenceConfig& config_;
    std::vector<Aabb> boxes_;  ///< by primitive id
    /// Primitive ids sorted by centre along x, y, z. A subtree owns the same range of each, and of
    /// scratch_ and right_areas_, alone.
    std::vector<std::uint32_t> lists_[3];
    std::vector<std::uint32_t> scratch_;
    std::vector<double> right_areas_;    ///< [i]: area of the primitives from i to the range's end
    std::vector<std::uint8_t> on_left_;  ///< by primitive id
    std::vector<BvhNode> nodes_;
};

}  // namespace

Tree build_reference(const geometry::TriangleMesh& mesh, const ReferenceConfig& config) {
    if (config.max_leaf_size == 0)
        throw std::invalid_argument("build_reference: max_leaf_size is 0; give at least 1");
    // More threads than cores gain nothing, and make TBB print a warning.
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(config.threads == 0 ? cores
                                              : std::min(static_cast<int>(config.threads), cores));
    return arena.execute([&] { return Build(mesh, config).run(); });
}

}  // namespace structures::bvh
