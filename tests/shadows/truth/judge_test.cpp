// The judge against the definition, on random scenes; and scenes made to hit its corner cases.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shadows/truth/truth.hpp"
#include "tests/shadows/truth/oracle.hpp"
#include "tests/shadows/truth/scenes.hpp"

namespace {

using namespace tests;
using shadows::kNoPrimitive;
using shadows::kNoReceiver;
using shadows::truth::JudgeOptions;
using shadows::truth::Truth;
using shadows::truth::Verdict;
using shadows::truth::Verdicts;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Bands on whose limit the distance is not, by what the judge's lower bounds may fall short.
void expect_band(const Verdict& verdict, Real distance, double epsilon) {
    const int bits[] = {Verdict::kWithin1, Verdict::kWithin4, Verdict::kWithin16};
    const double factors[] = {1, 4, 16};
    for (int i = 0; i < 3; ++i) {
        if (distance <= factors[i] * epsilon) {
            EXPECT_TRUE(verdict.bits & bits[i]) << factors[i];
        }
        if (distance > (factors[i] + 1e-3) * epsilon) {
            EXPECT_FALSE(verdict.bits & bits[i]) << factors[i];
        }
    }
}

class Judge : public testing::TestWithParam<unsigned> {};

TEST_P(Judge, EqualsTheDefinition) {
    Random random(GetParam());
    for (int scene = 0; scene < 12; ++scene) {
        TriangleMesh mesh = soup(random, random() % 24);
        if (random() % 2) append(mesh, ball(in_cube(random, 1), 0.5f, 3));
        const Light light = random_light(random, mesh);
        const Truth truth(mesh, light);
        std::vector<Place> places;
        for (int i = 0; i < 40; ++i) {
            places.push_back(random_place(random, mesh));
            if (random() % 2) places.back() = place_near_shadow(random, mesh, light);
        }
        const Verdicts verdicts = truth.judge(to_points(places), {});
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto& [p, own] = places[i];
            SCOPED_TRACE(testing::Message()
                         << "scene " << scene << ", point " << i << " on " << own);
            EXPECT_EQ(verdicts.points[i].shadowed(), shadowed_by_any(p, own, light, mesh));
            EXPECT_EQ(verdicts.points[i].shadowed(), truth.shadowed(p, own));
            expect_band(verdicts.points[i], clearance(p, own, light, mesh), truth.epsilon(p));
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Seeds, Judge, testing::Range(1u, 17u));

TEST(Judge, IsIndependentOfThreads) {
    Random random(5);
    const TriangleMesh mesh = soup(random, 60);
    const Truth truth(mesh, {Light::Type::point, {0, 3, 0}});
    std::vector<Place> places;
    for (int i = 0; i < 5000; ++i) places.push_back(random_place(random, mesh));
    const Verdicts one = truth.judge(to_points(places), {.threads = 1});
    const Verdicts many = truth.judge(to_points(places), {.threads = 7});
    EXPECT_EQ(one.points, many.points);
    EXPECT_EQ(one.effort.filtered, many.effort.filtered);
    EXPECT_EQ(one.effort.exact, many.effort.exact);
    EXPECT_EQ(one.effort.candidates, many.effort.candidates);
    EXPECT_GT(one.effort.filtered, 0u);
}

TEST(Judge, ReportsProgressAndStops) {
    const TriangleMesh mesh = floor_mesh(1, 0, 2);
    const Truth truth(mesh, {Light::Type::point, {0, 3, 0}});
    const shadows::PointArrays points =
        to_points(std::vector<Place>(4096, Place{{0.1f, -1, 0}, kNoReceiver}));
    std::vector<double> seen;
    truth.judge(points, {.threads = 1, .progress = [&](double done) {
                             seen.push_back(done);
                             return true;
                         }});
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1);
    EXPECT_THROW(truth.judge(points, {.threads = 2, .progress = [](double) { return false; }}),
                 std::runtime_error);
    EXPECT_THROW(
        truth.judge(points, {.threads = 2,
                             .progress = [](double) -> bool { throw std::logic_error("broken"); }}),
        std::logic_error);
}

TEST(Judge, CountsReceiversThatFaceAwayApart) {
    const TriangleMesh mesh = floor_mesh(1, 0, 1);
    const Truth point(mesh, {Light::Type::point, {0, 3, 0}});
    const Truth sun(mesh, {Light::Type::directional, {0, -2, 0}});
    const Place place{{0.5f, 0, 0.1f}, 1};
    for (const Truth* truth : {&point, &sun}) {
        EXPECT_FALSE(judge(*truth, place, {0, 1, 0}).facing_away());
        EXPECT_TRUE(judge(*truth, place, {0, -1, 0}).facing_away());
        EXPECT_FALSE(judge(*truth, place, {0, 0, 0}).facing_away()) << "no normal: faces the light";
        EXPECT_FALSE(judge(*truth, {place.p, kNoReceiver}, {0, -1, 0}).facing_away());
    }
    EXPECT_TRUE(judge(sun, place, {1, 0, 0}).facing_away()) << "edge-on";
}

TEST(Judge, NothingCasts) {
    TriangleMesh empty;
    const Place place{{0.5f, 0, 0.1f}, kNoReceiver};
    for (const auto type : {Light::Type::point, Light::Type::directional})
        EXPECT_EQ(judge(Truth(empty, {type, {0, 3, 1}}), place), Verdict{Verdict::kGeometry});
    const TriangleMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(judge(Truth(one, {Light::Type::point, {0, 0, 5}}), {{0.25f, 0.25f, 0}, 0}),
              Verdict{Verdict::kGeometry})
        << "a triangle does not shadow itself";
    EXPECT_EQ(judge(Truth(one, {Light::Type::point, {0, 0, 5}}), {{0, 0, 0}, kNoPrimitive}),
              Verdict{})
        << "background";
}

TEST(Judge, IgnoresBrokenTriangles) {
    Random random(3);
    TriangleMesh mesh = ball({0, 1, 0}, 0.5f, 4);
    append(mesh, floor_mesh(2, 0, 2));
    const Light light{Light::Type::point, {0.25f, 3, 0.5f}};
    TriangleMesh broken = mesh;
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3 v :
         {glm::vec3(kNan, 1, 0), glm::vec3(0, kInf, 0), glm::vec3(0, 0.5f, -kInf)})
        broken.positions.push_back(v);
    for (const glm::uvec3 t : {glm::uvec3{0, 1, n},
                               {n, n + 1, n + 2},
                               {2, n + 1, 3},
                               {4, 4, 5},
                               {6, 6, 6},
                               {7, 8, n + 2}})
        broken.triangles.push_back(t);
    const Truth plain(mesh, light), with_broken(broken, light);
    for (int i = 0; i < 500; ++i) {
        const Place place = random_place(random, mesh);
        EXPECT_EQ(judge(plain, place), judge(with_broken, place));
    }
    EXPECT_EQ(judge(with_broken, {{0, 0, 0}, static_cast<std::uint32_t>(mesh.triangle_count())}),
              judge(plain, {{0, 0, 0}, kNoReceiver}))
        << "a point may lie on a broken triangle";
}

TEST(Judge, RefusesWhatHasNoAnswer) {
    const TriangleMesh mesh = floor_mesh(1, 0, 1);
    for (const float bad : {kNan, kInf, -kInf}) {
        EXPECT_THROW(Truth(mesh, {Light::Type::point, {0, bad, 0}}), std::invalid_argument);
        EXPECT_THROW(Truth(mesh, {Light::Type::directional, {bad, 1, 0}}), std::invalid_argument);
    }
    EXPECT_THROW(Truth(mesh, {Light::Type::directional, {0, 0, 0}}), std::invalid_argument);
    const Truth truth(mesh, {Light::Type::point, {0, 3, 0}});
    EXPECT_THROW(judge(truth, {{kNan, 0, 0}, kNoReceiver}), std::invalid_argument);
    EXPECT_THROW(judge(truth, {{0, kInf, 0}, 0}), std::invalid_argument);
    EXPECT_THROW(judge(truth, {{0, 0, 0}, 2}), std::invalid_argument);
    EXPECT_NO_THROW(judge(truth, {{kNan, 0, 0}, kNoPrimitive}));
    shadows::PointArrays points = to_points({{{0, 0, 0}, kNoReceiver}});
    points.y.clear();
    EXPECT_THROW(truth.judge(points, {}), std::invalid_argument);
}

TEST(Judge, FarLightMakesAllAmbiguous) {
    const TriangleMesh mesh = ball({0, 1, 0}, 0.5f, 4);
    const Truth truth(mesh, {Light::Type::point, {1e30f, 1e30f, -1e30f}});
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Place place = random_place(random, mesh);
        EXPECT_TRUE(judge(truth, place).ambiguous());
        EXPECT_EQ(judge(truth, place).shadowed(),
                  shadowed_by_any(place.p, place.own, {Light::Type::point, {1e30f, 1e30f, -1e30f}},
                                  mesh));
    }
}

TEST(Judge, HoldsAtAllScales) {
    for (const float scale : {1e-30f, 1e-12f, 1.0f, 1e12f, 1e30f}) {
        TriangleMesh mesh{{{-1, 1, -1}, {1, 1, -1}, {0, 1, 1}}, {{0, 1, 2}}};
        for (glm::vec3& v : mesh.positions) v *= scale;
        const Truth truth(mesh, {Light::Type::point, {0, 3 * scale, 0}});
        const Verdict under = judge(truth, {{0, -scale, 0}, kNoReceiver});
        EXPECT_TRUE(under.shadowed() && under.certain()) << scale;
        const Verdict beside = judge(truth, {{3 * scale, -scale, 0}, kNoReceiver});
        EXPECT_TRUE(!beside.shadowed() && beside.certain()) << scale;
    }
}

TEST(Judge, LightOnTheMesh) {
    const TriangleMesh mesh{{{0, 1, 0}, {2, 1, 0}, {0, 1, 2}, {-3, 0, -3}, {3, 0, -3}, {0, 0, 4}},
                            {{0, 1, 2}, {3, 4, 5}}};
    for (const glm::vec3 light : {glm::vec3(0, 1, 0), {1, 1, 0}, {1, 1, 1}, {0.5f, 1, 0.5f}}) {
        const Truth truth(mesh, {Light::Type::point, light});
        const Verdict below = judge(truth, {{0.1f, 0.25f, 0.3f}, kNoReceiver});
        EXPECT_FALSE(below.shadowed()) << "the segment ends on the triangle and does not cross it";
        EXPECT_TRUE(below.ambiguous());
        const Verdict under = judge(truth, {{0.1f, -1, 0.3f}, kNoReceiver});
        EXPECT_TRUE(under.shadowed()) << "by the other triangle";
        EXPECT_TRUE(under.ambiguous());
    }
}

TEST(Judge, SegmentInThePlaneMeetsNothing) {
    const TriangleMesh mesh{{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Truth point(mesh, {Light::Type::point, {5, 0.5f, 0}});
    EXPECT_FALSE(judge(point, {{-5, 0.5f, 0}, kNoReceiver}).shadowed());
    const Truth sun(mesh, {Light::Type::directional, {0, -1, 0}});
    EXPECT_FALSE(judge(sun, {{0, -1, 0}, kNoReceiver}).shadowed());
}

TEST(Judge, DirectionalLightComesFromAgainstItsDirection) {
    const TriangleMesh mesh = ball({0, 5, 0}, 1, 4);
    const Truth truth(mesh, {Light::Type::directional, {0, -1e-3f, 0}});
    EXPECT_TRUE(judge(truth, {{0.1f, -1e3f, 0.1f}, kNoReceiver}).shadowed());
    EXPECT_FALSE(judge(truth, {{0.1f, 10, 0.1f}, kNoReceiver}).shadowed());
    EXPECT_FALSE(judge(truth, {{5, 0, 0}, kNoReceiver}).shadowed());
}

}  // namespace
