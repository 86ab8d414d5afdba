// Stress tests about size and place: what single precision leaves of a scene.
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

/// Of (x, z) in the shadow of a square.
double square_reach(double x, double z) { return std::max(std::abs(x), std::abs(z)); }

}  // namespace

Scenes far_light(Light::Type type) {
    Scene scene = make_scene("", either_light(type, {0, 1e4f, 0}, kDown));
    const std::uint32_t floor = add_floor(scene.mesh, {0, 0, 0}, 10);
    add_closed_box(scene.mesh, {-0.25, 1, -0.25}, {0.25, 1.5, 0.25});
    for (int i = 0; i < 256; ++i) {
        const double x = (i % 16 - 7.5) * 0.1, z = (i / 16 - 7.5) * 0.1;
        ask(scene, {x, 0, z}, by_reach(square_reach(x, z), 0.2, 0.4), floor_at(floor, x, z));
    }
    return {scene};
}

Scenes far_from_origin(Light::Type type) {
    const glm::dvec3 offset(0x1p20);
    Scene scene =
        make_scene("", either_light(type, glm::vec3(offset + glm::dvec3(0, 4000, 0)), kDown));
    const std::uint32_t floor = add_floor(scene.mesh, offset, 4000);
    add_closed_box(scene.mesh, offset + glm::dvec3(-400, 800, -400),
                   offset + glm::dvec3(400, 1600, 400));
    const double widest = type == Light::Type::point ? 400 / 0.6 : 400;
    for (int i = 0; i < 256; ++i) {
        const double x = (i % 16 - 7.6) * 140, z = (i / 16 - 7.5) * 140;
        ask(scene, offset + glm::dvec3(x, 0, z), by_reach(square_reach(x, z), 380, widest + 60),
            floor_at(floor, x, z));
    }
    return {scene};
}

Scenes contact_shadow(Light::Type type) {
    Scenes scenes;
    // Rays that start too far off the floor are in the box already, and leave it through its other
    // side; over a wall they jump.
    for (const bool box : {true, false}) {
        Scene scene =
            make_scene(box ? "box" : "wall", either_light(type, {4, 5, 0.5f}, {-0.8f, -1, -0.1f}));
        const std::uint32_t floor = add_floor(scene.mesh, {0, 0, 0}, 5);
        if (box)
            add_closed_box(scene.mesh, {-1, 0, -1}, {1, 1, 1});
        else
            scenes::add_quad(scene.mesh, {glm::dvec3(0, 0, -1), {0, 0, 1}, {0, 1, 1}, {0, 1, -1}});
        for (int i = 0; i < 256; ++i) {
            const double away = 0.002 * std::pow(1.7, i % 8) + (box ? 1 : 0);
            const double x = i % 16 < 8 ? -away : away, z = (i / 16 - 7.5) / 10;
            ask(scene, {x, 0, z}, i % 16 < 8 ? shadowed : lit, floor_at(floor, x, z));
        }
        scenes.push_back(scene);
    }
    return scenes;
}

}  // namespace experiments::stability
