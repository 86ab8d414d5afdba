// No triangle near the path is missed.
#include "shadows/truth/candidates.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "tests/shadows/truth/oracle.hpp"
#include "tests/shadows/truth/scenes.hpp"

namespace {

using namespace tests;
using shadows::truth::Candidates;
using shadows::truth::Path;

std::vector<bool> visited(const Candidates& candidates, const Path& path, std::size_t count) {
    std::vector<bool> seen(count);
    candidates.visit(path, [&](std::uint32_t slot) {
        EXPECT_FALSE(seen[candidates.order()[slot]]) << "visited twice";
        seen[candidates.order()[slot]] = true;
        return true;
    });
    return seen;
}

Real distance_to_path(Vector x, Vector p, Vector towards, Real end) {
    const Real size = glm::dot(towards, towards);
    const Real t = size > 0 ? std::clamp(glm::dot(x - p, towards) / size, Real(0), end) : Real(0);
    return glm::length(p + t * towards - x);
}

std::vector<std::uint32_t> sound_triangles(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> casters;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (!mesh.degenerate(t)) casters.push_back(t);
    return casters;
}

class Near : public testing::TestWithParam<unsigned> {};

TEST_P(Near, AllAreVisited) {
    Random random(GetParam());
    constexpr Real kEndless = std::numeric_limits<Real>::infinity();
    std::size_t near = 0, met = 0, all = 0;
    for (int scene = 0; scene < 40; ++scene) {
        TriangleMesh mesh = soup(random, 1 + random() % 60);
        const float scale = random() % 2 ? 1.0f : std::pow(10.0f, uniform(random, -20, 20));
        for (glm::vec3& v : mesh.positions) v *= scale;
        const std::vector<std::uint32_t> casters = sound_triangles(mesh);
        const Candidates candidates(mesh, casters);
        for (int i = 0; i < 50; ++i) {
            // Aim past a point of some triangle, at about the radius.
            const glm::vec3 p =
                random() % 2 ? scale * in_cube(random, 2) : awkward_place(random, mesh);
            const glm::vec3 aim = awkward_place(random, mesh);
            const float radius = scale * std::pow(10.0f, uniform(random, -6, -1));
            glm::vec3 towards = aim + in_cube(random, radius) - p;
            if (random() % 3 == 0) towards[random() % 3] = random() % 2 ? 0.0f : -0.0f;
            if (random() % 3 == 0) towards[random() % 3] = 0;
            const Real end = random() % 2 ? Real(1) : kEndless;
            const Path path(p, towards, double(end), radius);
            const std::vector<bool> seen = visited(candidates, path, mesh.triangle_count());
            for (const std::uint32_t t : casters) {
                const Vector a(mesh.corner(t, 0)), b(mesh.corner(t, 1)), c(mesh.corner(t, 2));
                Real closest = kEndless;
                for (const Vector& x : {a, b, c, (a + b) / Real(2), (a + b + c) / Real(3),
                                        Real(0.1) * a + Real(0.3) * b + Real(0.6) * c})
                    closest = std::min(closest, distance_to_path(x, p, towards, end));
                if (closest <= Real(radius)) {
                    EXPECT_TRUE(seen[t]) << double(closest) << " of " << radius;
                    ++near;
                }
                met += seen[t];
                ++all;
            }
        }
    }
    std::printf("[  seed %2u ] of %zu pairs %zu near, %zu visited\n", GetParam(), all, near, met);
    EXPECT_GT(near, all / 200);
    EXPECT_LT(met, all / 2);
}
INSTANTIATE_TEST_SUITE_P(Seeds, Near, testing::Range(1u, 9u));

TEST(Candidates, OfNothingAndOfOne) {
    TriangleMesh mesh;
    const Path path({0, 0, 0}, {0, 1, 0}, 1, 1e-3);
    EXPECT_TRUE(visited(Candidates(mesh, {}), path, 0).empty());
    mesh = {{{-1, 0.5f, -1}, {1, 0.5f, -1}, {0, 0.5f, 1}}, {{0, 1, 2}}};
    const std::uint32_t casters[] = {0};
    EXPECT_TRUE(visited(Candidates(mesh, casters), path, 1)[0]);
    EXPECT_FALSE(visited(Candidates(mesh, casters), Path({0, 0, 0}, {0, 0.25, 0}, 1, 1e-3), 1)[0]);
    EXPECT_TRUE(visited(Candidates(mesh, casters), Path({0, 0, 0}, {0, 0.25, 0}, 2, 1e-3), 1)[0]);
    EXPECT_TRUE(visited(Candidates(mesh, casters), Path({0, 0.5, 0}, {0, 0, 0}, 1, 1e-3), 1)[0]);
}

TEST(Candidates, AtExactlyTheRadius) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        // On a grid, so that the path passes the corner that is farthest along `side` at exactly
        // the radius.
        TriangleMesh mesh{{}, {{0, 1, 2}}};
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(glm::round(64.0f * in_cube(random, 1)));
        if (mesh.degenerate(0)) continue;
        const int side = static_cast<int>(random() % 3), along = (side + 1 + random() % 2) % 3;
        glm::vec3 p = mesh.positions[0], towards(0);
        for (const glm::vec3& v : mesh.positions)
            if (v[side] > p[side]) p = v;
        const float radius = std::ldexp(1.0f, -static_cast<int>(random() % 12));
        p[side] += radius;
        p[along] -= 16;
        towards[along] = 16;  // ends beside the corner
        const std::uint32_t casters[] = {0};
        EXPECT_TRUE(visited(Candidates(mesh, casters), Path(p, towards, 1, radius), 1)[0]);
        towards[side] = -0x1p-20f * radius;
        EXPECT_TRUE(visited(Candidates(mesh, casters), Path(p, towards, 1, radius), 1)[0]);
    }
}

TEST(Candidates, StopWhenAskedTo) {
    const TriangleMesh mesh = floor_mesh(1, 0, 8);
    const Candidates candidates(mesh, sound_triangles(mesh));
    int visits = 0;
    candidates.visit(Path({-2, 0, 0.1}, {4, 0, 0}, 1, 0.01),
                     [&](std::uint32_t) { return ++visits < 3; });
    EXPECT_EQ(visits, 3);
}

}  // namespace
