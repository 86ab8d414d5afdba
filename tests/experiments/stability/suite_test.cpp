// The scenes of the stress suite: the judge finds what geometry expects, as built and varied, and
// the tests are not empty.
#include "experiments/stability/suite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "experiments/stability/judge.hpp"
#include "experiments/stability/variations.hpp"

namespace {

using namespace experiments::stability;

const char* name_of(Light::Type type) {
    return type == Light::Type::point ? "point" : "directional";
}

TEST(StressSuite, NumbersAndNames) {
    std::set<std::string> labels;
    int number = 0;
    for (const StressTest& test : suite()) {
        EXPECT_EQ(test.number, ++number);
        EXPECT_TRUE(labels.insert(test.label()).second);
        EXPECT_FALSE(test.checks.empty());
        EXPECT_FALSE(test.light_types().empty());
    }
    EXPECT_EQ(number, 28);
    EXPECT_EQ(suite()[3].label(), "04_shared_edge");
}

class EveryTest : public testing::TestWithParam<StressTest> {
  protected:
    template <typename Use>
    void for_each_scene(const Use& use) const {
        for (const Light::Type type : GetParam().light_types())
            for (const Scene& scene : GetParam().build(type)) {
                SCOPED_TRACE(std::string(name_of(type)) + " " + scene.name);
                use(scene);
            }
    }
};

TEST_P(EveryTest, JudgeFindsWhatGeometryExpects) {
    int known = 0, certain = 0;
    for_each_scene([&](const Scene& scene) {
        EXPECT_GE(scene.points.size(), 64u);
        for (const ScenePoint& point : scene.points)
            EXPECT_TRUE(point.receiver == shadows::kNoReceiver ||
                        point.receiver < scene.mesh.triangle_count());
        try {
            const JudgedScene judged = judge(scene);
            for (std::size_t i = 0; i < scene.points.size(); ++i) {
                const auto verdict = judged.verdicts.points[place_in_image(i)];
                EXPECT_FALSE(verdict.facing_away());
                known += scene.points[i].expected != Expected::unsaid;
                certain += verdict.certain();
            }
        } catch (const std::runtime_error& error) {
            ADD_FAILURE() << error.what();
        }
    });
    EXPECT_GE(known, 64) << "points of known answer";
    // A light on a triangle makes every point ambiguous; such a scene asks for exact answers.
    if (GetParam().number != 12) {
        EXPECT_GE(certain, 64) << "points outside the band";
    }
}

TEST_P(EveryTest, VariationsKeepTheAnswers) {
    const Selection few{{}, 2, 1, {1e-4, 1e4}};
    for_each_scene([&](const Scene& scene) {
        for (const Variation& variation : variations(few, 1, GetParam().most)) {
            try {
                const JudgedScene judged = judge(vary(scene, variation));
                EXPECT_EQ(judged.scene.points.size(), scene.points.size());
            } catch (const std::runtime_error& error) {
                ADD_FAILURE() << variation.label() << ": " << error.what();
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(StressSuite, EveryTest, testing::ValuesIn(suite().begin(), suite().end()),
                         [](const auto& test) { return "T" + test.param.label(); });

TEST(Variations, KindsAndLimits) {
    const Selection config{{}, 3, 2, {0.5, 2, 4}};
    EXPECT_EQ(variations(config, 1, 1000).size(), 1u + 3 + 2 + 3);
    EXPECT_EQ(variations(config, 1, 1).size(), 4u);
    EXPECT_EQ(variations(config, 1, 0).size(), 1u);
    EXPECT_EQ(variations(config, 1, 1000)[0].label(), "as built");
    EXPECT_EQ(variations(config, 1, 1000)[7].label(), "scale 2");
}

Scene small_scene(const Light& light) {
    Scene scene = make_scene("", light);
    const std::uint32_t floor = add_floor(scene.mesh, {1, 0, 2}, 3);
    add_closed_box(scene.mesh, {0, 1, 0}, {1, 2, 1});
    scene.essential = 2;
    scene.exact = true;
    ask(scene, {1.5, 0, 2.25}, Expected::lit, floor_at(floor, 0.5, 0.25));
    ask(scene, {1, 5, 2}, Expected::unsaid);
    return scene;
}

TEST(Variations, AnOrderKeepsTheTrianglesThatPointsLieOn) {
    const Scene scene = small_scene(point_light({0, 9, 0}));
    const Scene varied = vary(scene, {Variation::Kind::order, 7});
    EXPECT_EQ(varied.mesh.positions, scene.mesh.positions);
    EXPECT_NE(varied.mesh.triangles, scene.mesh.triangles);
    EXPECT_EQ(varied.mesh.triangles[varied.points[0].receiver],
              scene.mesh.triangles[scene.points[0].receiver]);
    EXPECT_EQ(varied.points[1].receiver, shadows::kNoReceiver);
    EXPECT_EQ(varied.essential, 0u);
    EXPECT_TRUE(varied.as_built);
}

TEST(Variations, ATransformIsRigid) {
    for (const Light& light : {point_light({0, 9, 0}), directional_light({1, -2, 0.5f})}) {
        const Scene scene = small_scene(light);
        const Scene varied = vary(scene, {Variation::Kind::transform, 7});
        const auto distance = [](const Scene& s, int i, int k) {
            return glm::distance(s.mesh.positions[i], s.mesh.positions[k]);
        };
        for (int i = 1; i < 12; ++i)
            EXPECT_NEAR(distance(varied, 0, i), distance(scene, 0, i), 1e-4);
        const auto towards = [](const Scene& s) {
            const glm::vec3 p = s.points[0].position;
            return s.light.type == Light::Type::point ? glm::distance(s.light.vector, p)
                                                      : glm::length(s.light.vector);
        };
        EXPECT_NEAR(towards(varied), towards(scene), 1e-4);
        EXPECT_NE(varied.points[0].position, scene.points[0].position);
        EXPECT_FALSE(varied.as_built);
    }
}

TEST(Variations, AScaleSparesNothing) {
    const Scene scene = small_scene(point_light({0, 9, 0}));
    const Scene varied = vary(scene, {Variation::Kind::scale, 0, 0.25});
    for (std::size_t i = 0; i < scene.mesh.positions.size(); ++i)
        EXPECT_EQ(varied.mesh.positions[i], 0.25f * scene.mesh.positions[i]);
    EXPECT_EQ(varied.points[1].position, 0.25f * scene.points[1].position);
    EXPECT_EQ(varied.light.vector, glm::vec3(0, 2.25f, 0));
}

TEST(Judge, ContradictionIsAnError) {
    Scene scene = small_scene(point_light({1, 9, 2}));
    scene.essential = 0;
    ask(scene, {0.5, 0.25, 0.5}, Expected::shadowed);
    EXPECT_NO_THROW(judge(scene));
    scene.points.back().expected = Expected::lit;
    EXPECT_THROW(judge(scene), std::runtime_error);
    // The box counts, for it casts: declaring only the floor essential is wrong.
    scene.points.pop_back();
    ask(scene, {0.5, 0.25, 0.5}, Expected::unsaid);
    scene.essential = 2;
    EXPECT_THROW(judge(scene), std::runtime_error);
}

TEST(Judge, MarksCountAndFindTheWorst) {
    Scene scene = small_scene(point_light({1, 9, 2}));
    scene.essential = 0;
    ask(scene, {0.5, 0.25, 0.5}, Expected::shadowed);
    const JudgedScene judged = judge(scene);
    shadows::Visibility visible{std::vector<std::uint32_t>(shadows::kTilePoints / 32, 0xffffffffu)};
    Marks marks = judged.mark(visible);
    EXPECT_EQ(marks.score.false_lit, 1u);
    EXPECT_FALSE(marks.passed());
    ASSERT_TRUE(marks.worst);
    EXPECT_TRUE(marks.worst->called_lit);
    EXPECT_EQ(marks.worst->position, glm::vec3(0.5f, 0.25f, 0.5f));
    EXPECT_EQ(marks.worst->severity, 3);
    visible.words[place_in_image(2) / 32] &= ~(1u << place_in_image(2) % 32);
    marks = judged.mark(visible);
    EXPECT_TRUE(marks.passed());
    EXPECT_FALSE(marks.worst);
    EXPECT_THROW(judged.mark({}), std::invalid_argument);
}

}  // namespace
