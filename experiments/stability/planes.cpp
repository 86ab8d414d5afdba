// Stress tests about the planes of triangles: lights and rays in them or nearly so, planes that
// nearly coincide.
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

/// What an observer at `p` sees of a light on the surface of the box [-1, 1]^3. The segment enters
/// the box next to the light if it starts on the inner side of every face that the light is on.
Expected seen_past_box(glm::vec3 p, glm::vec3 light) {
    bool inside = true, enters = true;
    for (int axis = 0; axis < 3; ++axis) {
        inside = inside && std::abs(p[axis]) < 1;
        if (std::abs(light[axis]) == 1) enters = enters && p[axis] * light[axis] < 1;
    }
    return inside || !enters ? lit : shadowed;
}

}  // namespace

Scenes light_in_plane(Light::Type type) {
    Scenes scenes;
    for (const bool around : {false, true}) {
        Scene scene = make_scene(around ? "around the light" : "beside the light",
                                 either_light(type, kOrigin, {1, 0, 1}));
        scene.exact = true;
        if (around)
            add_triangle(scene.mesh, {-1, 0, -1}, {3, 0, -1}, {0, 0, 3});
        else
            add_triangle(scene.mesh, {1, 0, 1}, {3, 0, 1}, {2, 0, 3});
        for (int i = 0; i < 256; ++i) {
            const double y[] = {0, 0.25, -1, 3};
            ask(scene, {i % 8 * 0.75 - 1.125, y[i / 64], i / 8 % 8 * 0.75 - 1.25}, lit);
        }
        scenes.push_back(scene);
    }
    return scenes;
}

Scenes light_on_triangle(Light::Type) {
    struct Place {
        const char* name;
        glm::vec3 light;
    };
    Scenes scenes;
    for (const Place& place : {Place{"on a vertex", {1, 1, 1}}, Place{"on an edge", {1, 1, 0}},
                               Place{"on a face", {1, 0.25f, 0}}}) {
        Scene scene = make_scene(place.name, point_light(place.light));
        scene.exact = true;
        add_closed_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
        constexpr float kSteps[] = {-2, -1.25f, -0.5f, 0.375f, 0.75f, 1.5f};
        for (int i = 0; i < 6 * 6 * 6; ++i) {
            const glm::vec3 p(kSteps[i % 6], kSteps[i / 6 % 6], kSteps[i / 36]);
            ask(scene, p, seen_past_box(p, place.light));
        }
        scenes.push_back(scene);
    }
    return scenes;
}

namespace {

/// A fan of slivers, 1 long and 10^-6 wide each, that together cast a shadow of some width.
Scene sliver_fan(Light::Type type) {
    Scene scene = make_scene("fan", either_light(type, kOrigin, kDown));
    const glm::dvec3 apex(0, -3, 0);
    constexpr int kCount = 1024;
    const auto rim = [&](int i) { return apex + glm::dvec3(1, 0, 1e-6 * (i - kCount / 2)); };
    for (int i = 0; i < kCount; ++i) add_triangle(scene.mesh, apex, rim(i), rim(i + 1));
    for (int i = 0; i < 256; ++i) {
        const double along = 0.6 + 0.35 * (i % 16) / 15, across = 1.6 * (i / 16) / 15 - 0.8;
        const glm::dvec3 q = apex + along * glm::dvec3(1, 0, across * 1e-6 * kCount / 2);
        ask(scene, behind(scene.light, q, 2), std::abs(across) < 0.7 ? shadowed : unsaid);
    }
    return scene;
}

/// Triangles with one edge 10^-4 rad off the light's rays: shadows as wide as a hair.
Scene nearly_edge_on(Light::Type type) {
    Scene scene = make_scene("edge-on", either_light(type, kOrigin, kDown));
    constexpr double kOffsets[16] = {0,     2e-5, -2e-5, 5e-5,  -5e-5, 1e-4,  -1e-4, 2e-4,
                                     -2e-4, 1e-3, -1e-3, -5e-4, 1e-2,  -1e-2, 5e-2,  -5e-2};
    for (int i = 0; i < 16; ++i) {
        const glm::dvec3 a(0.2 * i - 1.5, -2, 0.1 * i - 0.7);
        const glm::dvec3 ray = glm::normalize(behind(scene.light, a, 2) - a);
        const glm::dvec3 across = glm::normalize(glm::cross(ray, {0, 0, 1}));
        add_triangle(scene.mesh, a, a + 1.5 * (ray + 1e-4 * across),
                     a + 0.75 * ray + glm::dvec3(0, 0, 0.05));
        for (const double offset : kOffsets) {
            const glm::dvec3 q = a + 0.8 * ray + glm::dvec3(0, 0, 0.02) + offset * across;
            ask(scene, behind(scene.light, q, 2), std::abs(offset) >= 1e-2 ? lit : unsaid);
        }
    }
    return scene;
}

}  // namespace

Scenes slivers(Light::Type type) { return {sliver_fan(type), nearly_edge_on(type)}; }

Scenes two_sheets(Light::Type type) {
    Scene scene = make_scene("", either_light(type, {0, 5, 0}, kDown));
    const double epsilon = 64 * 0x1p-24 * (5 + 1 + 5);  // of the points under the point light
    const double heights[] = {0, -64 * epsilon};
    for (const double y : heights) {
        const std::uint32_t sheet = add_floor(scene.mesh, {0, y, 0}, 1);
        for (int i = 0; i < 128; ++i) {
            const double x = i % 16 * 0.12 - 0.9, z = i / 16 * 0.24 - 0.85;
            ask(scene, {x, y, z}, y == 0 ? lit : shadowed, floor_at(sheet, x, z));
        }
    }
    return {scene};
}

}  // namespace experiments::stability
