// Signs against rational arithmetic.
#include "shadows/truth/exact.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "tests/shadows/truth/oracle.hpp"

namespace {

using namespace shadows::truth;

/// Any finite float, subnormals and extremes as often as the rest.
float any_float() {
    const auto bits = *rc::gen::arbitrary<std::uint32_t>();
    const auto value = std::bit_cast<float>(bits);
    return std::isfinite(value) ? value : std::bit_cast<float>(bits & 0xff7fffffu);
}
float tiny_float() { return std::bit_cast<float>(*rc::gen::inRange(0u, 64u)); }
float grid_float() { return float(*rc::gen::inRange(-4, 5)) * 0.25f; }

glm::vec3 vector_of(float (*component)()) {
    const float x = component(), y = component();
    return {x, y, component()};
}

/// A few units in the last place away.
float jitter(float value) {
    const int steps = *rc::gen::inRange(-2, 3);
    for (int i = 0; i < std::abs(steps); ++i)
        value = std::nextafter(value, steps > 0 ? std::numeric_limits<float>::max()
                                                : -std::numeric_limits<float>::max());
    return value;
}
glm::vec3 jitter(glm::vec3 v) { return {jitter(v.x), jitter(v.y), jitter(v.z)}; }

void expect_signs(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o) {
    const int expected = tests::rational_orientation(a, b, c, o);
    const int towards = tests::rational_orientation_towards(a, b, c, o);
    Signs signs;
    RC_ASSERT(exact_orientation(a, b, c, o) == expected);
    RC_ASSERT(orientation(a, b, c, o, signs) == expected);
    RC_ASSERT(exact_orientation_towards(a, b, c, o) == towards);
    RC_ASSERT(orientation_towards(a, b, c, o, signs) == towards);
    RC_ASSERT(signs.filtered + signs.exact == 2u);
    RC_ASSERT(orientation(b, a, c, o, signs) == -expected);
    RC_ASSERT(orientation(b, c, a, o, signs) == expected);
}

RC_GTEST_PROP(Signs, OfAnyFloats, ()) {
    expect_signs(vector_of(any_float), vector_of(any_float), vector_of(any_float),
                 vector_of(any_float));
}

RC_GTEST_PROP(Signs, OfSubnormals, ()) {
    expect_signs(vector_of(tiny_float), vector_of(tiny_float), vector_of(tiny_float),
                 vector_of(tiny_float));
}

RC_GTEST_PROP(Signs, OfMixedSizes, ()) {
    expect_signs(vector_of(any_float), vector_of(tiny_float), vector_of(grid_float),
                 vector_of(grid_float));
}

RC_GTEST_PROP(Signs, OnAGrid, ()) {
    expect_signs(vector_of(grid_float), vector_of(grid_float), vector_of(grid_float),
                 vector_of(grid_float));
}

RC_GTEST_PROP(Signs, OfNearlyFlatQuadruples, ()) {
    const float scale = std::ldexp(1.0f, *rc::gen::inRange(-100, 100));
    const auto component = [] { return float(*rc::gen::inRange(-(1 << 23), 1 << 23)); };
    const auto vector = [&] {
        const float x = component(), y = component();
        return scale * glm::vec3(x, y, component());
    };
    const glm::vec3 a = vector(), b = vector(), c = vector();
    const float u = float(*rc::gen::inRange(-64, 65)) / 64,
                v = float(*rc::gen::inRange(-64, 65)) / 64;
    expect_signs(a, b, c, jitter(a + u * (b - a) + v * (c - a)));
}

RC_GTEST_PROP(Signs, OfNearlyStraightTriples, ()) {
    const glm::vec3 a = vector_of(grid_float), b = vector_of(grid_float) * 3.7f;
    const float t = float(*rc::gen::inRange(-64, 65)) / 48;
    expect_signs(a, b, jitter(a + t * (b - a)), vector_of(grid_float));
}

// The filter alone, on planes through the origin seen from points so near it that differences in
// double precision lose them in part or altogether.
TEST(Signs, FilterAgreesWithIntegers) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-1000, 1000), factor(-20, 20), place(10, 80);
    const auto vector = [&] {
        const int x = coordinate(random), y = coordinate(random);
        return glm::vec3(x, y, coordinate(random));
    };
    Signs signs;
    int zeros = 0;
    for (int i = 0; i < 100000; ++i) {
        const glm::vec3 a = vector(), b = vector();
        const glm::vec3 c = float(factor(random)) * a + float(factor(random)) * b;
        glm::vec3 o(0);
        o[i % 3] = std::ldexp(random() % 2 ? 1.0f : -1.0f, -place(random));
        const int expected = exact_orientation(a, b, c, o);
        ASSERT_EQ(orientation(a, b, c, o, signs), expected);
        ASSERT_EQ(orientation_towards(a, b, c, o, signs), exact_orientation_towards(a, b, c, o));
        zeros += expected == 0;
    }
    EXPECT_GT(signs.exact, 10000u);
    EXPECT_GT(signs.filtered, 10000u);
    EXPECT_LT(zeros, 10000);
}

TEST(Signs, AreCounted) {
    Signs signs;
    EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, signs), 1);
    EXPECT_EQ(orientation({1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 0}, signs), 0);
    EXPECT_EQ(signs.filtered, 2u) << "a plane through the axes needs no integers";
    EXPECT_EQ(orientation({1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0, 0, 0}, signs), 0);
    EXPECT_EQ(signs.exact, 1u);
}

TEST(Signs, AtTheEndsOfTheRange) {
    const float big = std::numeric_limits<float>::max(),
                small = std::numeric_limits<float>::denorm_min();
    Signs signs;
    EXPECT_EQ(orientation({big, -big, -big}, {-big, big, -big}, {-big, -big, big}, {big, big, big},
                          signs),
              tests::rational_orientation({big, -big, -big}, {-big, big, -big}, {-big, -big, big},
                                          {big, big, big}));
    EXPECT_EQ(orientation({small, 0, 0}, {0, small, 0}, {0, 0, small}, {0, 0, 0}, signs), 1);
    EXPECT_EQ(orientation({big, 0, small}, {0, big, 0}, {big, big, 0}, {0, 0, 0}, signs), -1);
}

}  // namespace
