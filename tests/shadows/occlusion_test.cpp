// The filter of the occlusion test never contradicts exact arithmetic, however ill-conditioned the
// triangle and whatever the scale, and it leaves little to decide.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/support/occlusion.hpp"

namespace {

using structures::geometry::Light;
using tests::Decision;

struct Case {
    glm::vec3 p, a, b, c;
    Light light;
};

std::ostream& operator<<(std::ostream& out, const Case& x) {
    out << std::hexfloat << (x.light.type == Light::Type::point ? "point" : "directional");
    for (const glm::vec3& v : {x.light.vector, x.p, x.a, x.b, x.c})
        out << " (" << v.x << ", " << v.y << ", " << v.z << ')';
    return out;
}

class Generator {
  public:
    explicit Generator(std::uint32_t seed) : random_(seed) {}

    float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
    int integer(int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(random_);
    }
    glm::vec3 vector() { return {2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1}; }
    glm::vec3 lattice() {
        return {float(integer(-3, 3)), float(integer(-3, 3)), float(integer(-3, 3))};
    }
    /// Beside v: by a few ulps, or by more.
    glm::vec3 nudged(glm::vec3 v) {
        if (integer(0, 2) == 0) return v + std::ldexp(1.f, integer(-28, -8)) * vector();
        for (int axis = 0; axis < 3; ++axis)
            for (int i = integer(-2, 2); i != 0; i += i < 0 ? 1 : -1)
                v[axis] = std::nextafter(v[axis], i < 0 ? -1e30f : 1e30f);
        return v;
    }
    /// Any finite float, all exponents alike.
    float any_float() {
        return std::ldexp(2 * unit() - 1, integer(-140, 120)) * float(integer(0, 7) != 0);
    }
    Light light(glm::vec3 vector) {
        const bool point = integer(0, 1) == 0 || vector == glm::vec3(0);
        return {point ? Light::Type::point : Light::Type::directional, vector};
    }

  private:
    std::mt19937 random_;
};

/// Counts how often the filter decides; it must be right when it does.
void check(const char* name, std::uint32_t count, double decided_at_least,
           const std::function<Case(Generator&)>& make) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("%s: seed %u\n", name, seed);
    Generator generate(seed);
    std::uint32_t decided = 0, hits = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Case x = make(generate);
        const Decision decision = tests::occludes_filtered(x.p, x.light, x.a, x.b, x.c);
        const bool exact = tests::occludes_exactly(x.p, x.light, x.a, x.b, x.c);
        hits += exact;
        if (decision == Decision::unsure) continue;
        ++decided;
        ASSERT_EQ(decision == Decision::yes, exact) << name << ": " << x;
    }
    std::printf("%s: %.2f%% decided, %.2f%% hits\n", name, 100.0 * decided / count,
                100.0 * hits / count);
    EXPECT_GE(decided, decided_at_least * count);
}

constexpr std::uint32_t kCount = 60'000;

TEST(OcclusionFilter, OrdinaryTriangles) {
    check("ordinary", kCount, 0.999, [](Generator& g) {
        return Case{g.vector(), g.vector(), g.vector(), g.vector(), g.light(g.vector())};
    });
}

TEST(OcclusionFilter, SegmentsThroughEdgesAndCorners) {
    check("edges", kCount, 0, [](Generator& g) {
        Case x{g.vector(), g.vector(), g.vector(), g.vector(), {}};
        const glm::vec3 on = g.integer(0, 2) == 0 ? x.a : glm::mix(x.a, x.b, g.unit());
        const glm::vec3 towards = (on - x.p) * (g.unit() * 3);
        const bool point = g.integer(0, 1) == 0;
        x.light = {point ? Light::Type::point : Light::Type::directional,
                   g.nudged(point ? x.p + towards : -towards)};
        return x;
    });
}

TEST(OcclusionFilter, EndsOnTheTriangle) {
    check("ends", kCount, 0, [](Generator& g) {
        Case x{{}, g.vector(), g.vector(), g.vector(), {}};
        const float s = g.unit(), t = g.unit() * (1 - s);
        const glm::vec3 on = g.nudged(x.a + s * (x.b - x.a) + t * (x.c - x.a));
        const bool light_there = g.integer(0, 1) == 0;
        x.p = light_there ? g.vector() : on;
        x.light = light_there ? Light{Light::Type::point, on} : g.light(g.vector());
        return x;
    });
}

TEST(OcclusionFilter, EdgeOnTriangles) {
    check("edge on", kCount, 0, [](Generator& g) {
        Case x{g.vector(), g.vector(), {}, {}, {}};
        const glm::vec3 towards = g.vector();
        x.light = {Light::Type::point, x.p + towards};
        if (g.integer(0, 1)) x.light = {Light::Type::directional, -towards};
        x.b = g.nudged(x.a + (2 * g.unit() - 1) * towards +
                       std::ldexp(1.f, g.integer(-30, 0)) * g.vector());
        x.c = g.nudged(x.p + 2 * g.unit() * towards + g.unit() * (x.b - x.a) +
                       std::ldexp(1.f, g.integer(-30, -10)) * g.vector());
        return x;
    });
}

// Triangles of size 2^-40 .. 1 at distances of about 1 from the receiver, near the segment: rounded
// corners lie farther off than the triangle is large.
TEST(OcclusionFilter, TrianglesSmallerThanTheirRounding) {
    check("tiny", kCount, 0, [](Generator& g) {
        Case x;
        x.p = g.vector();
        const glm::vec3 at = std::ldexp(1.f, g.integer(-40, 0)) * g.vector();
        const float extent = std::ldexp(1.f, g.integer(-40, 0));
        x.a = at + extent * g.vector();
        x.b = at + extent * g.vector();
        x.c = at + extent * g.vector();
        const glm::vec3 towards = (at - x.p) * (3 * g.unit());
        x.light = {Light::Type::point, x.p + towards};
        if (g.integer(0, 1)) x.light = {Light::Type::directional, -towards};
        return x;
    });
}

TEST(OcclusionFilter, NeedlesThroughTheSegment) {
    check("needles", kCount, 0, [](Generator& g) {
        Case x;
        x.p = g.vector();
        x.light = g.light(g.vector());
        const glm::vec3 to =
            x.light.type == Light::Type::point ? x.light.vector : x.p - x.light.vector;
        const glm::vec3 on = glm::mix(x.p, to, g.unit()), along = 100.f * g.vector();
        x.a = on - along;
        x.b = on + along;
        x.c = g.nudged(x.b + std::ldexp(1.f, g.integer(-20, 0)) * g.vector());
        return x;
    });
}

TEST(OcclusionFilter, SmallIntegers) {
    check("lattice", kCount, 0, [](Generator& g) {
        return Case{g.lattice(), g.lattice(), g.lattice(), g.lattice(), g.light(g.lattice())};
    });
}

TEST(OcclusionFilter, EveryScale) {
    check("scales", kCount, 0, [](Generator& g) {
        const float scale = std::ldexp(1.f, g.integer(-140, 120));
        const float reach = std::ldexp(1.f, g.integer(-30, 5));
        Case x{g.vector(), g.vector(), g.vector(), g.vector(), g.light(g.vector())};
        for (glm::vec3* v : {&x.p, &x.a, &x.b, &x.c}) *v *= scale;
        x.light.vector *= scale * reach;
        return x;
    });
    check("15 orders down", 5000, 0.9, [](Generator& g) {
        return Case{1e-12f * g.vector(),
                    1e-12f * g.vector(),
                    1e-12f * g.vector(),
                    1e-12f * g.vector(),
                    {Light::Type::point, 1e-12f * g.vector()}};
    });
    check("15 orders up", 5000, 0.99, [](Generator& g) {
        return Case{1e15f * g.vector(),
                    1e15f * g.vector(),
                    1e15f * g.vector(),
                    1e15f * g.vector(),
                    {Light::Type::point, 1e15f * g.vector()}};
    });
}

TEST(OcclusionFilter, EveryFloat) {
    check("any float", kCount, 0, [](Generator& g) {
        const auto vector = [&] { return glm::vec3(g.any_float(), g.any_float(), g.any_float()); };
        return Case{vector(), vector(), vector(), vector(), g.light(vector())};
    });
}

// A light far away is the usual sun: single precision must still do.
TEST(OcclusionFilter, DistantLights) {
    for (float distance : {1e3f, 1e6f, 1e12f, 1e29f})
        check("distant", 5000, 0.98, [&](Generator& g) {
            return Case{g.vector(),
                        g.vector(),
                        g.vector(),
                        g.vector(),
                        {Light::Type::point, distance * (g.vector() + glm::vec3(2, 0, 0))}};
        });
}

TEST(OcclusionFilter, WhatIsNotFiniteIsNotDecidedWrongly) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const glm::vec3 a(-1, -1, 0), b(1, -1, 0), c(0, 1, 0), p(0, 0, -1);
    for (const glm::vec3& at : {glm::vec3(nan), glm::vec3(nan, 0, 1), glm::vec3(0, 0, nan)})
        EXPECT_NE(tests::occludes_filtered(p, {Light::Type::point, at}, a, b, c), Decision::yes);
    EXPECT_NE(tests::occludes_filtered({0, 0, nan}, {Light::Type::point, {0, 0, 1}}, a, b, c),
              Decision::yes);
    // No way to the light, no occluder.
    EXPECT_FALSE(tests::occludes_exactly({0, 0, 0}, {Light::Type::point, {0, 0, 0}}, a, b, c));
}

}  // namespace
