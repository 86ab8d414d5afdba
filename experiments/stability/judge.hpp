// One scene of the suite with the truth about it, and a method's answer held against that.
//
//     const JudgedScene judged = judge(scene);  // throws if truth and expectation differ
//     const Marks marks = judged.mark(visible);
//     if (!marks.passed()) report(*marks.worst);
#pragma once

#include <optional>

#include "experiments/stability/scene.hpp"
#include "shadows/truth/score.hpp"

namespace experiments::stability {

/// A point answered wrongly.
struct WrongPoint {
    glm::vec3 position;
    bool called_lit;
    int severity;  ///< 3: more than 16 epsilon off any change, 2: 4, 1: 1, 0: within the band
};

struct Marks {
    shadows::truth::Score score;
    std::uint32_t unexpected = 0;  ///< in an exact scene: not as expected, within the band
    std::optional<WrongPoint> worst{};

    bool passed() const {
        return score.false_lit == 0 && score.false_shadowed == 0 && unexpected == 0;
    }
};

struct JudgedScene {
    Scene scene;
    Image image;
    shadows::truth::Verdicts verdicts;

    /// Throws std::invalid_argument if `visible` is no answer to these points.
    Marks mark(const shadows::Visibility& visible) const;
};

/// Judges the points. Throws std::runtime_error if the judge does not find what geometry expects:
/// at every point where it is certain, and at all points of a scene as built; or if triangles
/// beyond the essential ones change the image.
JudgedScene judge(const Scene& scene);

}  // namespace experiments::stability
