// The band: whatever a small move of the point changes must be marked, interior edges must not.
#include <gtest/gtest.h>

#include "shadows/truth/truth.hpp"
#include "tests/shadows/truth/scenes.hpp"

namespace {

using namespace tests;
using shadows::truth::Truth;
using shadows::truth::Verdict;

Verdict judge(const Truth& truth, const Place& place, glm::vec3 normal = glm::vec3(0)) {
    shadows::PointArrays points{{place.p.x}, {place.p.y}, {place.p.z}, {place.own}, {normal}};
    return truth.judge(points, {.threads = 1}).points[0];
}

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

class Band : public testing::TestWithParam<unsigned> {};

TEST_P(Band, HoldsWhateverChangesNearby) {
    Random random(GetParam());
    Tally tally;
    for (int scene = 0; scene < 40; ++scene) {
        const TriangleMesh mesh = soup(random, 1 + random() % 12);
        const Truth truth(mesh, random_light(random, mesh));
        for (int i = 0; i < 60; ++i) expect_sound(truth, random_place(random, mesh), tally);
    }
    RecordProperty("changing", tally.changing);
    RecordProperty("ambiguous", tally.ambiguous);
    std::printf("%d bands: %d change, %d ambiguous\n", tally.points, tally.changing,
                tally.ambiguous);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Band, testing::Range(1u, 9u));

}  // namespace
