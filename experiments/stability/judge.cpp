#include "experiments/stability/judge.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace experiments::stability {
namespace {

using shadows::truth::Truth;
using shadows::truth::Verdict;

shadows::truth::Verdicts verdicts_of(const TriangleMesh& mesh, const Scene& scene,
                                     const Image& image) {
    return Truth(mesh, scene.light).judge(image.arrays, {});
}

void fail(const ScenePoint& point, const char* expected, const char* found) {
    throw std::runtime_error(fmt::format("at ({}, {}, {}) the suite expects {}, the judge finds {}",
                                         point.position.x, point.position.y, point.position.z,
                                         expected, found));
}

void check_expectations(const JudgedScene& judged) {
    for (std::size_t i = 0; i < judged.scene.points.size(); ++i) {
        const ScenePoint& point = judged.scene.points[i];
        const Verdict verdict = judged.verdicts.points[place_in_image(i)];
        if (point.expected == Expected::unsaid || !(judged.scene.as_built || verdict.certain()))
            continue;
        const bool shadowed = point.expected == Expected::shadowed;
        if (verdict.shadowed() == shadowed) continue;
        shadowed ? fail(point, "shadow", "light") : fail(point, "light", "shadow");
    }
}

void check_essential(const JudgedScene& judged) {
    TriangleMesh essential = judged.scene.mesh;
    essential.triangles.resize(judged.scene.essential);
    const auto reference = verdicts_of(essential, judged.scene, judged.image);
    for (std::size_t i = 0; i < judged.scene.points.size(); ++i) {
        const Verdict one = reference.points[place_in_image(i)],
                      all = judged.verdicts.points[place_in_image(i)];
        if (one.certain() && all.certain() && one.shadowed() != all.shadowed())
            fail(judged.scene.points[i], one.shadowed() ? "still shadow" : "still light",
                 "that triangles which do not count have changed it");
    }
}

int severity(const Verdict& verdict) {
    return verdict.ambiguous()                 ? 0
           : verdict.bits & Verdict::kWithin4  ? 1
           : verdict.bits & Verdict::kWithin16 ? 2
                                               : 3;
}

}  // namespace

JudgedScene judge(const Scene& scene) {
    JudgedScene judged{scene, make_image(scene), {}};
    judged.verdicts = verdicts_of(scene.mesh, scene, judged.image);
    check_expectations(judged);
    if (scene.essential > 0) check_essential(judged);
    return judged;
}

Marks JudgedScene::mark(const shadows::Visibility& visible) const {
    Marks marks{score_answer(verdicts, visible, image.width, image.height)};
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const std::uint32_t at = place_in_image(i);
        const Verdict verdict = verdicts.points[at];
        const bool lit = visible.lit(at);
        const bool unexpected = scene.exact && scene.as_built &&
                                scene.points[i].expected != Expected::unsaid &&
                                lit != (scene.points[i].expected == Expected::lit);
        if (verdict.ambiguous() ? !unexpected : lit != verdict.shadowed()) continue;
        if (verdict.facing_away()) continue;
        if (verdict.ambiguous()) ++marks.unexpected;
        const WrongPoint wrong{scene.points[i].position, lit, severity(verdict)};
        if (!marks.worst || wrong.severity > marks.worst->severity) marks.worst = wrong;
    }
    return marks;
}

}  // namespace experiments::stability
