// Random scenes of everything that is hard at once, exact methods against the judge.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/experiments/stability/answer.hpp"

namespace {

using namespace experiments::stability;
using experiments::scenes::Random;

glm::dvec3 in_box(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// On a grid of quarters: coordinates and planes coincide exactly, again and again.
glm::dvec3 on_grid(Random& random) {
    return glm::dvec3(random.index(9), random.index(9), random.index(9)) * 0.25 - 1.0;
}

/// Triangles with a corner in common with one that is there already.
void add_neighbour(TriangleMesh& mesh, Random& random) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.emplace_back(in_box(random));
    mesh.triangles.emplace_back(random.index(count), random.index(count), count);
}

/// Two corners on one line of sight, up to `angle`, and the third beside it.
void add_edge_on(TriangleMesh& mesh, Random& random, const Light& light, double angle) {
    const glm::dvec3 a = in_box(random);
    const glm::dvec3 ray = glm::normalize(behind(light, a, 2) - a + 1e-9);
    add_triangle(mesh, a, a + 0.5 * ray + angle * random.direction(),
                 a + 0.25 * ray + 0.2 * random.direction());
}

void add_something(TriangleMesh& mesh, Random& random, const Light& light) {
    const glm::dvec3 a = in_box(random), d = random.direction();
    switch (random.index(7)) {
        case 0:  // of any shape
            return add_triangle(mesh, a, in_box(random), in_box(random));
        case 1:  // a sliver
            return add_triangle(mesh, a, a + d, a + 0.5 * d + 1e-6 * random.direction());
        case 2:  // of integer-like coordinates, in planes shared with others
            return add_triangle(mesh, on_grid(random), on_grid(random), on_grid(random));
        case 3: {  // a stack
            const double y = 0.5 * random.index(3) - 0.5;
            for (int i = 0; i < 3; ++i)
                add_floor(mesh, {0.25 * random.index(3), y, 0.25 * random.index(3)}, 0.5);
            return;
        }
        case 4:
            if (!mesh.positions.empty()) add_neighbour(mesh, random);
            return;
        case 5:
            return add_edge_on(mesh, random, light, 1e-6);
        default:
            return add_edge_on(mesh, random, light, 0);
    }
}

glm::dvec3 on_triangle(const TriangleMesh& mesh, std::uint32_t t, Random& random) {
    glm::dvec3 w(random.uniform(), random.uniform(), random.uniform());
    if (random.index(4) == 0) w[int(random.index(3))] = 0;
    if (random.index(8) == 0) w = glm::dvec3(1, 0, 0);
    w /= w.x + w.y + w.z;
    return w.x * glm::dvec3(mesh.corner(t, 0)) + w.y * glm::dvec3(mesh.corner(t, 1)) +
           w.z * glm::dvec3(mesh.corner(t, 2));
}

/// Points on triangles and in their shadows, exactly behind vertices and edges now and then.
Scene soup(std::uint64_t seed, int size, double scale) {
    Random random(seed);
    Light light = random.index(3) == 0 ? directional_light(glm::vec3(random.direction()))
                                       : point_light(glm::vec3(1.5 * random.direction()));
    Scene scene = make_scene("", light);
    while (int(scene.mesh.triangle_count()) < size) add_something(scene.mesh, random, light);
    const auto count = static_cast<std::uint32_t>(scene.mesh.triangle_count());
    if (light.type == Light::Type::point && random.index(3) == 0)
        scene.light.vector = on_triangle(scene.mesh, random.index(count), random);
    for (int i = 0; i < 512; ++i) {
        const std::uint32_t t = random.index(count);
        const glm::dvec3 q = on_triangle(scene.mesh, t, random);
        const bool on_it = random.index(2) == 0 && !scene.mesh.degenerate(t);
        ask(scene, on_it ? q : behind(scene.light, q, random.uniform(1, 2)), Expected::unsaid,
            on_it ? t : shadows::kNoReceiver);
    }
    for (glm::vec3& p : scene.mesh.positions) p *= float(scale);
    for (ScenePoint& point : scene.points) point.position *= float(scale);
    if (light.type == Light::Type::point) scene.light.vector *= float(scale);
    return scene;
}

class MethodSoup : public tests::GpuTest, public testing::WithParamInterface<const char*> {};

TEST_P(MethodSoup, AgreesWithTheJudge) {
    const auto method = tests::make_method(GetParam(), {});
    const bool ok = rc::check([&] {
        const auto seed = *rc::gen::arbitrary<std::uint64_t>();
        const int size = *rc::gen::inRange(1, 120);
        const double scale = *rc::gen::element(1.0, 1e-4, 1e4);
        const Marks marks = tests::answer(*method, judge(soup(seed, size, scale)));
        RC_LOG() << marks.score.false_lit << " false lit, " << marks.score.false_shadowed
                 << " false shadowed of " << marks.score.points - marks.score.ambiguous << '\n';
        if (marks.worst)
            RC_LOG() << marks.worst->position.x << ' ' << marks.worst->position.y << ' '
                     << marks.worst->position.z << " severity " << marks.worst->severity << '\n';
        RC_ASSERT(marks.passed());
    });
    EXPECT_TRUE(ok);
}

INSTANTIATE_TEST_SUITE_P(Default, MethodSoup, testing::Values("bvh", "metric_tree"),
                         [](const auto& method) { return std::string(method.param); });

}  // namespace
