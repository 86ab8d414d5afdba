// The band: whatever a small move of the point changes must be marked, interior edges must not.
#include "shadows/truth/band.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "shadows/truth/truth.hpp"
#include "tests/shadows/truth/oracle.hpp"
#include "tests/shadows/truth/scenes.hpp"

namespace {

using namespace tests;
using shadows::kNoReceiver;
using shadows::truth::Truth;
using shadows::truth::Verdict;

/// Offsets disagree => ambiguous, at 1, 4 and 16 epsilon. Counts both to report their ratio.
struct Tally {
    int points = 0, changing = 0, ambiguous = 0;
};
void expect_sound(const Truth& truth, const Place& place, Tally& tally) {
    const Verdict verdict = judge(truth, place);
    const double epsilon = truth.epsilon(place.p);
    const struct {
        double radius;
        int bit;
    } bands[] = {{1, Verdict::kWithin1}, {4, Verdict::kWithin4}, {16, Verdict::kWithin16}};
    for (const auto& band : bands) {
        const bool changes = truth.changes_nearby(place.p, place.own, band.radius * epsilon);
        if (changes) {
            EXPECT_TRUE(verdict.bits & band.bit)
                << "within " << band.radius << " epsilon of (" << place.p.x << ", " << place.p.y
                << ", " << place.p.z << ") on " << place.own;
        }
        ++tally.points;
        tally.changing += changes;
        tally.ambiguous += (verdict.bits & band.bit) != 0;
    }
}

class Band : public testing::TestWithParam<unsigned> {
  protected:
    void report(const Tally& tally) {
        std::printf("[  seed %2u ] of %d bands %d change nearby, %d are ambiguous\n", GetParam(),
                    tally.points, tally.changing, tally.ambiguous);
        EXPECT_GT(tally.changing, tally.points / 100) << "the scenes should test something";
        EXPECT_LT(tally.ambiguous, 10 * tally.changing) << "much is called ambiguous for nothing";
    }
};

TEST_P(Band, HoldsWhateverChangesNearbyInSoups) {
    Random random(GetParam());
    Tally tally;
    for (int scene = 0; scene < 40; ++scene) {
        const TriangleMesh mesh = soup(random, 1 + random() % 12);
        const Light light = random_light(random, mesh);
        const Truth truth(mesh, light);
        for (int i = 0; i < 60; ++i)
            expect_sound(
                truth,
                random() % 2 ? random_place(random, mesh) : place_near_shadow(random, mesh, light),
                tally);
    }
    report(tally);
}

TEST_P(Band, HoldsWhateverChangesNearbyUnderMeshes) {
    Random random(GetParam());
    Tally tally;
    for (int scene = 0; scene < 6; ++scene) {
        TriangleMesh mesh = ball(in_cube(random, 1), 0.7f, 3 + random() % 6);
        append(mesh, floor_mesh(3, -1.3f, 1 + random() % 4));
        const Light light = random_light(random, mesh);
        const Truth truth(mesh, light);
        for (int i = 0; i < 200; ++i)
            expect_sound(truth, place_near_shadow(random, mesh, light), tally);
    }
    report(tally);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Band, testing::Range(1u, 9u));

// A quad, and a fan about a corner that no axis goes through: points behind the diagonal, behind
// the fan's centre and its spokes are surely shadowed, and a leak there would be an error.
TEST(Band, LeavesInteriorEdgesCertain) {
    const TriangleMesh quad{{{-1, -3, -1}, {1, -3, -1}, {1, -3, 1}, {-1, -3, 1}},
                            {{0, 1, 2}, {0, 2, 3}}};
    const Truth behind_quad(quad, {Light::Type::point, {0, 0, 0}});
    for (int i = -7; i <= 7; ++i) {
        const float x = float(i) / 8;
        const Verdict verdict = judge(behind_quad, {2.0f * glm::vec3(x, -3, x), kNoReceiver});
        EXPECT_TRUE(verdict.shadowed() && verdict.certain()) << x;
    }
    EXPECT_TRUE(judge(behind_quad, {{2, -6, 0.5f}, kNoReceiver}).ambiguous()) << "the outline";

    TriangleMesh fan{{{0.1f, -3, 0.2f}}, {}};
    for (std::uint32_t i = 0; i < 64; ++i) {
        const double turn = 6.283185307179586 * i / 64;
        fan.positions.push_back(fan.positions[0] + glm::vec3(std::cos(turn), 0.1, std::sin(turn)));
        fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 64});
    }
    const Truth behind_fan(fan, {Light::Type::point, {0, 0, 0}});
    for (std::uint32_t i = 0; i <= 64; ++i) {
        const glm::vec3 spoke = 0.5f * (fan.positions[0] + fan.positions[i]);
        const Verdict verdict = judge(behind_fan, {2.0f * spoke, kNoReceiver});
        EXPECT_TRUE(verdict.shadowed() && verdict.certain()) << i;
    }
}

TEST(Band, WeldsByPositionWhateverTheWinding) {
    // The diagonal's corners occur twice, and -0 is 0; the triangles are wound against each other.
    const TriangleMesh quad{
        {{-1, -3, -1}, {1, -3, -1}, {1, -3, 1}, {-1, -3, 1}, {-1, -3, -1}, {1, -3, 1}},
        {{0, 1, 2}, {4, 3, 5}}};
    const Truth truth(quad, {Light::Type::point, {0, 0, 0}});
    EXPECT_TRUE(judge(truth, {{0.5f, -6, 0.5f}, kNoReceiver}).certain());
    const TriangleMesh zeros{{{0.0f, 1, 0}, {1, 1, 0}, {1, 1, 1}, {-0.0f, 1, -0.0f}, {0, 1, 1}},
                             {{0, 1, 2}, {3, 2, 4}}};
    const Truth sun(zeros, {Light::Type::directional, {0, -1, 0}});
    EXPECT_TRUE(judge(sun, {{0.25f, 0, 0.25f}, kNoReceiver}).certain());
    EXPECT_TRUE(judge(sun, {{0.25f, 0, 0}, kNoReceiver}).ambiguous());
}

// Where two layers end at the same edge their multiplicities add up; back to back, the surface
// folds back over itself, and its edge is an outline too.
TEST(Band, CountsMultiplicity) {
    const TriangleMesh folded{{{-1, 1, 0}, {1, 1, 0}, {0, 1, 2}, {0, 2, 2}, {0, 1, -2}},
                              {{0, 1, 2}, {0, 1, 3}}};
    const Place under{{0, 0, 0}, kNoReceiver};
    EXPECT_TRUE(judge(Truth(folded, {Light::Type::directional, {0, -1, 0}}), under).ambiguous());
    TriangleMesh book = folded;
    book.triangles.push_back({1, 0, 4});
    EXPECT_TRUE(judge(Truth(book, {Light::Type::directional, {0, -1, 0}}), under).ambiguous())
        << "two layers on one side, one on the other";
    book.triangles.pop_back();
    book.triangles[1] = {1, 0, 4};
    EXPECT_TRUE(judge(Truth(book, {Light::Type::directional, {0, -1, 0}}), under).certain())
        << "one on each";
}

// Two pages continue each other; the third, hanging almost in the light's direction, is the point's
// own, and what the others make of their common edge is all that counts.
TEST(Band, LeavesTheOwnTriangleOutOfItsEdges) {
    const TriangleMesh book{{{-1, 1, 0}, {1, 1, 0}, {0, 1, 2}, {0, 1, -2}, {0, -5, 1e-6f}},
                            {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
    const Truth sun(book, {Light::Type::directional, {0, -1, 0}});
    EXPECT_TRUE(judge(sun, {{0, -2, 0.5e-6f}, 2}).certain());
    EXPECT_TRUE(judge(sun, {{0, -2, 0.5e-6f}, kNoReceiver}).ambiguous());

    const Truth lamp(book, {Light::Type::point, {0, 1, 0.5f}});
    EXPECT_TRUE(judge(lamp, {{0.5f, -2, 0}, 1}).ambiguous()) << "the light lies on a page";
    const TriangleMesh page{book.positions, {{0, 1, 2}}};
    EXPECT_TRUE(judge(Truth(page, {Light::Type::point, {0, 1, 0.5f}}), {{0, 1, 1}, 0}).certain())
        << "it lies on the point's own";
}

// A point rounded to the wrong side of a slanted floor is shadowed by the neighbours of its own
// triangle, at grazing light far from it. Such points are within rounding.
TEST(Band, HoldsPointsThatRoundedBelowTheirFloor) {
    Random random(11);
    int shadowed = 0, certain = 0;
    for (int scene = 0; scene < 20; ++scene) {
        TriangleMesh mesh = floor_mesh(1, 0, 16);
        const glm::vec3 slope = in_cube(random, 0.5f);
        for (glm::vec3& v : mesh.positions) v.y = slope.x * v.x + slope.z * v.z + 7.7f;
        const glm::vec3 up = glm::normalize(glm::vec3(-slope.x, 1, -slope.z));
        const glm::vec3 along = glm::cross(up, in_cube(random, 1));
        const float grazing = std::pow(10.0f, uniform(random, -4, -1.5f));
        const Truth truth(mesh, {Light::Type::directional, -along - grazing * up});
        for (int i = 0; i < 2000; ++i) {
            const auto own = static_cast<std::uint32_t>(random() % mesh.triangle_count());
            const glm::vec3 a = mesh.corner(own, 0);
            const glm::vec3 p = a + uniform(random, 0, 0.5f) * (mesh.corner(own, 1) - a) +
                                uniform(random, 0, 0.5f) * (mesh.corner(own, 2) - a);
            const Verdict verdict = judge(truth, {p, own});
            shadowed += verdict.shadowed();
            certain += verdict.certain();
            EXPECT_FALSE(verdict.shadowed() && verdict.certain());
        }
    }
    std::printf("%d of 40000 points shadowed, %d certain\n", shadowed, certain);
    EXPECT_GT(shadowed, 20);
    EXPECT_GT(certain, 10000);
}

TEST(Band, HoldsContactButNotTheOwnTriangle) {
    TriangleMesh mesh = floor_mesh(1, 0, 1);
    const Truth alone(mesh, {Light::Type::point, {0.3f, 4, 0.1f}});
    const Place place{{0.5f, 0, 0.5f}, 1};
    EXPECT_TRUE(judge(alone, place).certain());
    EXPECT_TRUE(judge(alone, {place.p, kNoReceiver}).ambiguous()) << "on the floor, not its own";
    const double epsilon = alone.epsilon(place.p);
    for (const double height : {0.5, 3.0, 12.0, 40.0}) {
        TriangleMesh sheets = mesh;
        append(sheets, floor_mesh(1, float(-height * epsilon), 1));
        const Verdict verdict = judge(Truth(sheets, {Light::Type::point, {0.3f, 4, 0.1f}}), place);
        EXPECT_FALSE(verdict.shadowed());
        EXPECT_EQ((verdict.bits & Verdict::kWithin1) != 0, height < 1);
        EXPECT_EQ((verdict.bits & Verdict::kWithin4) != 0, height < 4);
        EXPECT_EQ((verdict.bits & Verdict::kWithin16) != 0, height < 16);
    }
}

// Lower bounds, and tight but for ill-defined planes.
TEST(Band, DistancesAreLowerBounds) {
    Random random(7);
    for (int i = 0; i < 20000; ++i) {
        const TriangleMesh mesh = soup(random, 1);
        if (mesh.degenerate(0)) continue;
        const glm::vec3 a = mesh.corner(0, 0), b = mesh.corner(0, 1), c = mesh.corner(0, 2);
        const glm::vec3 p = awkward_place(random, mesh) + in_cube(random, 1e-3f);
        const Light light = random_light(random, mesh);
        const double scale = 16;
        const Real triangle = distance_to_triangle(Vector(p), Vector(a), Vector(b), Vector(c));
        const double found = shadows::truth::triangle_distance(p, a, b, c);
        EXPECT_LE(found, triangle);
        EXPECT_GT(found, triangle - 1e-7 * scale);
        const Real quad = distance_to_quad(p, a, b, light);
        const double bound = shadows::truth::shadow_quad_distance(p, a, b, light, 1e30);
        EXPECT_LE(bound, quad + 1e-15 * scale);
        const double early = shadows::truth::shadow_quad_distance(p, a, b, light, 1e-3);
        EXPECT_LE(early, quad + 1e-15 * scale);
        if (bound <= 1e-3) {
            EXPECT_EQ(early, bound);
        }
        const glm::dvec3 from = glm::dvec3(a) - glm::dvec3(light.vector), edge = glm::dvec3(b - a);
        if (light.type == Light::Type::point &&
            glm::length(glm::cross(from, edge)) > 1e-5 * glm::length(from) * glm::length(edge)) {
            EXPECT_GT(bound, quad - 1e-8 * scale);
        }
    }
}

}  // namespace
