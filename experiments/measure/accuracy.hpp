// Accuracy as a measured quantity: the truth about a scene's points, and what each answer is worth
// against it.
//
//     const Judgement judgement(session, "city", input, points);
//     Samples samples = judgement.score(visible);       // false_lit, false_shadowed, ...
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/measure/scene_input.hpp"
#include "experiments/measure/session.hpp"
#include "experiments/measure/summary.hpp"
#include "shadows/truth/score.hpp"

namespace experiments::measure {

class Judgement {
  public:
    /// Takes the verdicts on `points` from the session's cache, or judges them, with progress, and
    /// stores them. `points` must outlive this.
    Judgement(Session& session, const std::string& scene, const SceneInput& input,
              const shadows::Points& points);

    /// The accuracy metrics of one answer.
    structures::Samples score(const shadows::Visibility& visible) const;
    /// What is wrong with the answer at each pixel, row by row from the top.
    std::vector<shadows::truth::Error> mask(const shadows::Visibility& visible) const;
    /// How the truth was found.
    structures::Samples effort() const;

  private:
    const shadows::Points& points_;
    shadows::truth::Verdicts verdicts_;
    bool cached_ = false;
};

/// A line for every method that claims to be exact and, in any repetition, answered a point outside
/// the rounding band wrongly.
std::vector<std::string> broken_claims(std::span<const ResultSummary> results);

}  // namespace experiments::measure
