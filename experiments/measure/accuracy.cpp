#include "experiments/measure/accuracy.hpp"

#include <fmt/format.h>

namespace experiments::measure {

using shadows::truth::Score;

Judgement::Judgement(Session& session, const std::string& scene, const SceneInput& input,
                     const shadows::Points& points)
    : points_(points) {
    const std::string key = truth_key(input.mesh, input.light, points.host());
    if (auto known = session.truth_cache.load(key, points.count())) {
        verdicts_ = std::move(*known);
        cached_ = true;
    } else {
        shadows::truth::JudgeOptions options;
        options.progress = [&](double done) {
            session.progress.update(fmt::format("{}: truth {:.0f} %", scene, 100 * done));
            return true;
        };
        const shadows::truth::Truth truth(input.mesh, input.light);
        verdicts_ = truth.judge(points.host(), options);
        session.truth_cache.store(key, verdicts_);
    }
    std::size_t facing = 0, certain = 0;
    for (const shadows::truth::Verdict verdict : verdicts_.points) {
        if (!verdict.geometry() || verdict.facing_away()) continue;
        ++facing;
        certain += verdict.certain();
    }
    if (facing > 0 && certain == 0)
        session.progress.note(scene +
                              ": every point that faces the light lies within the "
                              "rounding band: no answer can be called wrong");
}

structures::Samples Judgement::score(const shadows::Visibility& visible) const {
    const Score score = score_answer(verdicts_, visible, points_.width(), points_.height());
    const double errors = double(score.false_lit) + score.false_shadowed;
    return {{"false_lit", double(score.false_lit)},
            {"false_shadowed", double(score.false_shadowed)},
            {"errors_per_million", score.points > 0 ? 1e6 * errors / score.points : 0},
            {"ambiguous", double(score.ambiguous)},
            {"facing_away", double(score.facing_away)},
            {"disagreeing_1", double(score.disagreeing[0])},
            {"disagreeing_4", double(score.disagreeing[1])},
            {"disagreeing_16", double(score.disagreeing[2])},
            {"facing_away_errors", double(score.facing_away_errors)},
            {"leaks", double(score.leaks)},
            {"leak_largest", double(score.leak_largest)}};
}

std::vector<shadows::truth::Error> Judgement::mask(const shadows::Visibility& visible) const {
    return error_mask(verdicts_, visible, points_.width(), points_.height());
}

structures::Samples Judgement::effort() const {
    return {{"truth_ms", verdicts_.effort.milliseconds, "ms"},
            {"truth_filtered", double(verdicts_.effort.filtered)},
            {"truth_exact", double(verdicts_.effort.exact)},
            {"truth_candidates", double(verdicts_.effort.candidates)},
            {"truth_cached", double(cached_)}};
}

std::vector<std::string> broken_claims(std::span<const ResultSummary> results) {
    std::vector<std::string> lines;
    const auto worst = [](const ResultSummary& result, const char* metric) {
        const MetricSummary* summary = result.find(metric);
        return summary ? summary->statistics.max : 0;
    };
    for (const ResultSummary& result : results) {
        const double lit = worst(result, "false_lit"), dark = worst(result, "false_shadowed");
        if (worst(result, "claims_exact") == 0 || lit + dark == 0) continue;
        lines.push_back(
            fmt::format("{}, {}: claims to be exact, but answers {} points falsely lit "
                        "and {} falsely shadowed outside the rounding band",
                        result.scene, result.label(), lit, dark));
    }
    return lines;
}

}  // namespace experiments::measure
