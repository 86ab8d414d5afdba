// Stress tests about where the light, the casters and the points are relative to one another.
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

}  // namespace

Scenes closed_room(Light::Type type) {
    Scene scene = make_scene("", either_light(type, {0.2f, 0.3f, -0.1f}, {0.3f, -1, 0.2f}));
    add_closed_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
    const Expected inside = type == Light::Type::point ? lit : shadowed;
    const Expected outside = type == Light::Type::point ? shadowed : unsaid;
    scenes::Random random(6);
    for (int i = 0; i < 96; ++i) {
        const glm::dvec3 p(random.uniform(-0.98, 0.98), random.uniform(-0.98, 0.98),
                           random.uniform(-0.98, 0.98));
        ask(scene, p, inside);
    }
    for (int i = 0; i < 96; ++i) ask(scene, random.uniform(1.8, 5) * random.direction(), outside);
    for (int i = 0; i < 64; ++i) {  // on the floor, whose triangles are the last two
        const double x = random.uniform(-0.95, 0.95), z = random.uniform(-0.95, 0.95);
        ask(scene, {x, -1, z}, inside, x >= z ? 10 : 11);
    }
    return {scene};
}

Scenes no_casters(Light::Type type) {
    const Light light = either_light(type, {0, 4, 0}, kDown);
    Scene no_triangles = make_scene("no triangles", light), no_area = make_scene("no area", light),
          aside = make_scene("none in between", light);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 a(i - 4, 1, 0), b(i, 2, i);
        add_triangle(no_area.mesh, a, a, b);
        add_triangle(no_area.mesh, a, b, a + 2.0 * (b - a));
    }
    for (int i = 0; i < 64; ++i) {
        // Below all points; and, for a point light, above the light.
        const double y = i % 2 && type == Light::Type::point ? 5 : -1;
        add_triangle(aside.mesh, {i % 8 - 4, y, i / 8 - 4}, {i % 8 - 3, y, i / 8 - 4},
                     {i % 8 - 4, y - 0.5, i / 8 - 3});
    }
    Scenes scenes{no_triangles, no_area, aside};
    for (Scene& scene : scenes)
        for (int i = 0; i < 256; ++i)
            ask(scene, {i % 16 * 0.5 - 4, 0.1 * (i % 5), i / 16 * 0.5 - 4}, lit);
    return scenes;
}

Scenes caster_beyond(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    // The mirror image, in the light, of where it would cast: a plane through the light alone does
    // not tell the two apart.
    const double height = type == Light::Type::point ? 5 : -8;
    add_floor(scene.mesh, {0, height, 0}, 1);
    add_floor(scene.mesh, {0, height * 1.25, 0}, 3);
    for (int i = 0; i < 256; ++i) ask(scene, {i % 16 * 0.2 - 1.5, -5, i / 16 * 0.2 - 1.5}, lit);
    return {scene};
}

Scenes caster_behind_camera(Light::Type type) {
    // The camera is at the origin and looks along -z at a wall; the caster is at its back and the
    // light behind that.
    Scene scene = make_scene("", either_light(type, {0, 0.5f, 10}, {0, 0, -1}));
    scenes::add_quad(scene.mesh,
                     {glm::dvec3(-10, -10, -5), {10, -10, -5}, {10, 10, -5}, {-10, 10, -5}});
    scenes::add_quad(scene.mesh, {glm::dvec3(-0.5, 0, 5), {0.5, 0, 5}, {0.5, 1, 5}, {-0.5, 1, 5}});
    const double size = type == Light::Type::point ? 1.5 : 0.5;
    for (int i = 0; i < 256; ++i) {
        const double x = (i % 16 - 7.5) / 7.5 * 2 * size, y = (i / 16 - 7.5) / 7.5 * 2 * size;
        const double reach = std::max(std::abs(x), std::abs(y)) / size;
        const std::uint32_t own = x >= y + 0.5 ? 0 : 1;
        ask(scene, {x, y + 0.5, -5}, by_reach(reach, 0.98, 1.02), own);
    }
    return {scene};
}

}  // namespace experiments::stability
