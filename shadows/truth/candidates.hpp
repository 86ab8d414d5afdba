// Which triangles may shadow a point, or bound shadow near it: those whose boxes come near the
// segment to the light. A binary BVH in single precision, walked in double precision.
//
//     Candidates candidates(mesh, casters);
//     candidates.visit(Path(p, towards, 1, radius), [&](std::uint32_t slot) { ...; return go_on;
//     });
//     // slot i is triangle candidates.order()[i]
//
// Conservative: a triangle with a point x within `radius` of a point y of the path is visited.
// y lies in the triangle's box grown by the radius on every side, and so in all boxes above it,
// grown alike. Such a box is entered between the largest of three entry times and left at the
// smallest of three exit times, in units of `towards`; computed times can differ from the true
// ones. Let plane be a coordinate of the box, c = plane - (p -+ R), computed with two roundings,
// where R = radius (1 + 2^-20). If |plane - p| < 2 (|p| + R), the error of c is less than 2^-50
// (|p| + R) < 2^-20 radius by the requirement radius >= 2^-23 |p|, so c lies on the outer side of
// its value for `radius`. Else c does not cancel and is right to within a factor 1 + 2^-51; its
// time c / towards is right to within 1 + 2^-49 (towards: one rounding, reciprocal, product), and
// has the right sign. So if the box is met, entry <= exit (1 + 2^-46) holds for the computed times,
// which are positive or clamped to be. Where `towards` is 0, its reciprocal is taken as 2^600: c,
// which is never 0 then, becomes a time beyond all others, before or after the path as it should.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structures/geometry/triangle_mesh.hpp"

namespace shadows::truth {

/// The points within `radius` of {p + t towards : 0 <= t <= end}. `radius` > 0 must be at least
/// 2^-23 times the largest coordinate of p; components of `towards` may be off by a factor
/// 1 + 2^-53.
struct Path {
    Path(const glm::dvec3& p, const glm::dvec3& towards, double end, double radius);
    glm::dvec3 inverse;
    glm::dvec3 enter, leave;      ///< planes' origins: p moved by the radius, against and along
    std::array<int, 3> backward;  ///< 1 where `towards` points down
    double end;
};

class Candidates {
  public:
    /// `casters` are triangles of `mesh` with finite corners, none degenerate.
    Candidates(const structures::geometry::TriangleMesh& mesh,
               std::span<const std::uint32_t> casters);

    /// The casters, in the order of the leaves.
    const std::vector<std::uint32_t>& order() const { return order_; }

    /// Calls visit(slot) for every caster near `path`, and some others, until it returns false.
    template <typename Visit>
    void visit(const Path& path, Visit&& visit) const;

  private:
    /// An inner node with the boxes of its two children; bounds[0]: lower, bounds[1]: upper planes.
    struct Node {
        float bounds[2][3][2];
        std::uint32_t first[2];  ///< node, or first slot of a leaf
        std::uint32_t count[2];  ///< of a leaf, else 0
    };
    static constexpr std::uint32_t kMaxDepth = 64;

    std::vector<Node> nodes_;  ///< the root comes first; none: nothing to visit
    std::vector<std::uint32_t> order_;
};

template <typename Visit>
void Candidates::visit(const Path& path, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kMaxDepth + 2> stack{0};
    std::uint32_t waiting = 1;
    while (waiting > 0) {
        const Node& node = nodes_[stack[--waiting]];
        double entry[2] = {0, 0}, exit[2] = {path.end, path.end};
        for (int axis = 0; axis < 3; ++axis) {
            const int backward = path.backward[axis];
            const float* near = node.bounds[backward][axis];
            const float* far = node.bounds[1 - backward][axis];
            for (int child = 0; child < 2; ++child) {
                const double enter = (near[child] - path.enter[axis]) * path.inverse[axis];
                const double leave = (far[child] - path.leave[axis]) * path.inverse[axis];
                entry[child] = enter > entry[child] ? enter : entry[child];
                exit[child] = leave < exit[child] ? leave : exit[child];
            }
        }
        for (int child = 0; child < 2; ++child) {
            if (!(entry[child] <= exit[child] * (1 + 0x1p-46))) continue;
            if (node.count[child] == 0) {
                stack[waiting++] = node.first[child];
                continue;
            }
            for (std::uint32_t i = 0; i < node.count[child]; ++i)
                if (!visit(node.first[child] + i)) return;
        }
    }
}

}  // namespace shadows::truth
