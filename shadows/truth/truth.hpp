// The judge of every shadow method: for each point, is the light exactly visible on the inputs as
// they are, and how close is the point to where the answer changes?
//
//     Truth truth(mesh, light);
//     Verdicts verdicts = truth.judge(points.host(), {});
//     Score score = score_answer(verdicts, visible, points.width(), points.height());
//     // score.false_lit and score.false_shadowed are 0 for an exact method
//
// Exact: a triangle T shadows p if the open segment from p to the light (or the open ray against a
// directional light's direction) crosses the closed triangle transversally, and T is not the
// triangle p lies on. A segment in the plane of T does not meet it. Decided on the single-precision
// inputs without rounding: see exact.hpp.
//
// Band: epsilon(p) = 64 u (|p - L| + |p|_inf + |L|_inf), u = 2^-24. A point is *certain* if within
// epsilon of it there is neither a silhouette shadow quad (the part behind an edge whose
// multiplicity is not 0) nor a triangle other than its own, and no such triangle within epsilon of
// the light. Otherwise it is *ambiguous*: moving p by a few roundings may change the answer. An
// edge between two triangles that both face the light has multiplicity 0, so light that leaks
// through it is an error. For a directional light |p - L| is the diagonal of the scene's bounds and
// |L|_inf the largest coordinate of these bounds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace shadows::truth {

/// To be raised whenever verdicts may come out otherwise than before: stored ones carry it.
inline constexpr int kVersion = 1;

/// What is known of one point, in one byte.
struct Verdict {
    enum Bits : std::uint8_t {
        kGeometry = 1,    ///< the point lies on geometry; all else is 0 if not
        kShadowed = 2,    ///< the exact answer
        kFacingAway = 4,  ///< N . (L - p) <= 0: counted apart
        kWithin1 = 8,     ///< ambiguous: a change of the answer may lie within epsilon
        kWithin4 = 16,    ///< ... within 4 epsilon
        kWithin16 = 32,   ///< ... within 16 epsilon
    };
    std::uint8_t bits = 0;

    bool geometry() const { return bits & kGeometry; }
    bool shadowed() const { return bits & kShadowed; }
    bool facing_away() const { return bits & kFacingAway; }
    bool ambiguous() const { return bits & kWithin1; }
    bool certain() const { return geometry() && !ambiguous(); }
    bool operator==(const Verdict&) const = default;
};

/// How the predicates were decided.
struct Effort {
    std::uint64_t filtered = 0;    ///< signs that the floating-point filter vouched for
    std::uint64_t exact = 0;       ///< signs that needed exact arithmetic
    std::uint64_t candidates = 0;  ///< triangles examined
    double milliseconds = 0;       ///< wall time
    Effort& operator+=(const Effort& other);
};

struct Verdicts {
    std::vector<Verdict> points;  ///< in the order of the points
    Effort effort;
};

struct JudgeOptions {
    unsigned threads = 0;  ///< 0: all cores
    /// Called at the start and now and then, from one thread at a time, with the fraction done;
    /// returns false to stop (judge() then throws std::runtime_error).
    std::function<bool(double)> progress;
};

class Truth {
  public:
    /// Takes in the scene: welds edges, finds their multiplicities as seen from the light, builds
    /// the candidate tree. `mesh` must outlive this. Degenerate triangles, among them those with a
    /// corner that is not finite, cast no shadow. Throws std::invalid_argument if the light is not
    /// finite, or a directional one is 0.
    Truth(const structures::geometry::TriangleMesh& mesh, const structures::geometry::Light& light);
    ~Truth();

    /// Throws std::invalid_argument if the arrays differ in length, a point with geometry is not
    /// finite, or its primitive is no triangle of the mesh.
    Verdicts judge(const PointArrays& points, const JudgeOptions& options) const;

    /// The exact answer for one point; `own` is the triangle it lies on, kNoReceiver if none.
    /// Throws std::invalid_argument as judge() does.
    bool shadowed(glm::vec3 p, std::uint32_t own) const;
    /// Band of one point.
    double epsilon(glm::vec3 p) const;
    /// The cheap band: whether the exact answers at p and at 14 points around it, `radius` away
    /// along the axes and the diagonals of their octants, are not all the same. What it finds
    /// within k epsilon, judge() calls ambiguous within k epsilon.
    bool changes_nearby(glm::vec3 p, std::uint32_t own, double radius) const;

  private:
    struct Scene;
    std::unique_ptr<const Scene> scene_;
};

}  // namespace shadows::truth
