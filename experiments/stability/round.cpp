// Stress tests about balls, cables and capsules, as triangle meshes of the same shapes.
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

/// Points around the stretch a-b, at most 4 radii away: lit within it, shadowed outside.
void ask_around(Scene& scene, glm::dvec3 a, glm::dvec3 b, double radius) {
    scenes::Random random(13);
    for (int i = 0; i < 256; ++i) {
        const glm::dvec3 core = a + random.uniform() * (b - a);
        const double reach = i % 2 ? random.uniform(0, 0.8) : random.uniform(1.05, 4);
        const glm::dvec3 p = core + reach * radius * random.direction();
        const double t =
            a == b ? 0 : glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
        const double distance = glm::distance(p, a + t * (b - a)) / radius;
        ask(scene, p, distance < 0.85 ? lit : distance > 1.02 ? shadowed : unsaid);
    }
}

}  // namespace

Scenes light_inside_round(Light::Type) {
    Scene ball = make_scene("ball", point_light(kOrigin));
    scenes::add_sphere(ball.mesh, {0.1, 0, 0.05}, 1, 16);
    ask_around(ball, {0.1, 0, 0.05}, {0.1, 0, 0.05}, 1);
    Scenes scenes{ball};
    for (const double height : {0.1, 0.0}) {
        Scene scene = make_scene(height > 0 ? "capsule" : "capsule's axis", point_light(kOrigin));
        const glm::dvec3 a(-2, height, 0), b(2, height, 0);
        add_capsule(scene.mesh, a, b, 0.5, 16);
        ask_around(scene, a, b, 0.5);
        scenes.push_back(scene);
    }
    return scenes;
}

Scenes long_cable(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    add_cable(scene.mesh, {-10, -0.05, 0}, {10, -0.05, 0}, 0.01, 12);
    const bool point = type == Light::Type::point;
    // Seen from the light, the radius spans asin(0.2): 0.204 on the floor, all along.
    const double half_length = point ? 190 : 9.9, half_width = point ? 0.204 : 0.01;
    for (int i = 0; i < 256; ++i) {
        const double x = half_length * (i / 8 - 15.5) / 15.5;
        const double across[] = {0, 0.3, -0.5, 0.8, -0.9, 1.2, -2, 4};
        ask(scene, {x, -1, across[i % 8] * half_width},
            std::abs(across[i % 8]) < 0.95 ? shadowed : lit);
    }
    return {scene};
}

Scenes balls_at_threshold(Light::Type type) {
    // Angular radius of every ball and the threshold of the first, on the axis. Two rings of balls
    // begin and end exactly at the threshold.
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    const double radius = 0.4, distance = 4, spans = std::asin(radius / distance), threshold = 0.5;
    const auto add_ball = [&](double angle, double turns) {
        const glm::dvec2 c = scenes::unit_circle(turns);
        const glm::dvec3 center =
            distance * glm::dvec3(std::sin(angle) * c.x, -std::cos(angle), std::sin(angle) * c.y);
        scenes::add_sphere(scene.mesh, center, radius, 8);
        for (int i = 0; i < 16; ++i) {
            const glm::dvec2 d = scenes::unit_circle(i / 16.0);
            const double reach = 0.05 * radius * i;
            ask(scene, behind(scene.light, center + reach * glm::dvec3(d.x, 0, d.y), 2),
                reach < 0.6 * radius ? shadowed : unsaid);
        }
    };
    add_ball(0, 0);
    for (int i = 0; i < 6; ++i) {
        add_ball(threshold - spans, i / 6.0);
        add_ball(threshold + spans, (i + 0.5) / 6.0);
    }
    for (int i = 0; i < 32; ++i) {
        const glm::dvec2 c = scenes::unit_circle(i / 32.0);
        ask(scene, behind(scene.light, {4 * c.x, -3.0, 4 * c.y}, 2), lit);
    }
    return {scene};
}

Scenes capsule_end_on(Light::Type) {
    Scene scene = make_scene("", directional_light(kDown));
    const double radius = 0.5;
    add_capsule(scene.mesh, {0, -1, 0}, {0, -3, 0}, radius, 16);
    for (int i = 0; i < 256; ++i) {
        const glm::dvec2 c = scenes::unit_circle(i / 64.0 + 0.003 * (i % 7));
        const double reach = 1.9 * (i % 16) / 15;
        const double y = i / 128 ? -6 : -2;  // below, and beside where it is outside
        if (y == -2 && reach < 1.02) continue;
        ask(scene, {reach * radius * c.x, y, reach * radius * c.y}, by_reach(reach, 0.97, 1.02));
    }
    return {scene};
}

Scenes crossing_capsules(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    const double radius = 0.02;
    add_capsule(scene.mesh, {-10, -1, 0}, {10, -1, 0}, radius, 12);
    add_capsule(scene.mesh, {0, -1.05, -10}, {0, -1.05, 10}, radius, 12);
    for (int i = 0; i < 256; ++i) {
        const double along = 9.95 * (i / 8 - 15.5) / 15.5;
        const double across = (i / 2 % 4 - 1) * 0.6 * radius;  // -0.6, 0, 0.6 and 1.2 radii
        const glm::dvec3 q =
            i % 2 ? glm::dvec3(along, -1, across) : glm::dvec3(across, -1.05, along);
        ask(scene, behind(scene.light, q, 2), std::abs(across) < 0.9 * radius ? shadowed : unsaid);
        if (i % 4 == 0 && std::abs(along) > 1)
            ask(scene,
                behind(scene.light, q + (i % 2 ? glm::dvec3(0, 0, 0.2) : glm::dvec3(0.2, 0, 0)), 2),
                lit);
    }
    return {scene};
}

}  // namespace experiments::stability
