// Stress tests of many triangles at once: copies, rows, crossings, and some that are broken.
#include <array>
#include <cmath>
#include <limits>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

}  // namespace

Scenes piercing_plate(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    add_floor(scene.mesh, {0, -5, 0}, 5);  // first of all
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 at(i % 20 * 0.4 - 3.8, -5, i / 20 * 0.4 - 1.8);
        const glm::dvec3 a = at + glm::dvec3(-0.1, 0.1, -0.1), b = at + glm::dvec3(0.1, 0.1, -0.1),
                         c = at + glm::dvec3(0, -0.1, 0.2);
        add_triangle(scene.mesh, a, b, c);
        // Two fifths of the way down, at y = -4.94; the shadow falls on the air above the plate.
        const glm::dvec3 q = 0.4 * a + 0.4 * b + 0.2 * c;
        ask(scene, on_height(scene.light, q, -4.99), shadowed);
    }
    for (int i = 0; i < 56; ++i) ask(scene, {i % 8 - 3.5, -4.99, i / 8 % 2 ? 4.5 : -4.5}, lit);
    return {scene};
}

Scenes repeated_triangle(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    add_triangle(scene.mesh, {-1, -30, -1}, {1, -30.2, -1}, {0, -29.9, 1.5});
    // Outposts: the copies are a small part of the scene, which rasterisers would otherwise fill
    // with them 100,000 times.
    for (int i = 0; i < 8; ++i) {
        const glm::dvec2 c = 50.0 * scenes::unit_circle(i / 8.0);
        const glm::dvec3 at(c.x, -30, c.y);
        add_triangle(scene.mesh, at, at + glm::dvec3(0.1, 0, 0), at + glm::dvec3(0, 0, 0.1));
    }
    scene.essential = scene.mesh.triangle_count();
    scene.mesh.triangles.resize(100'000 + scene.essential, scene.mesh.triangles[0]);
    for (int i = 0; i < 256; ++i) {
        const glm::dvec3 q((i % 16 - 7.5) * 0.25, -30, (i / 16 - 7.5) * 0.25);
        ask(scene, behind(scene.light, q, 2), by_reach(std::hypot(q.x, q.z), 0.48, 1.6));
    }
    return {scene};
}

Scenes coaxial_clusters(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, {0, 0, -1}));
    for (int i = 0; i < 10'000; ++i) {
        glm::dvec3 corners[3];
        for (int k = 0; k < 3; ++k)  // turned by the golden angle from one to the next
            corners[k] = {0.1 * scenes::unit_circle(i * 0.381966 + k / 3.0), -5 - 0.0495 * i};
        add_triangle(scene.mesh, corners[0], corners[1], corners[2]);
    }
    for (int i = 0; i < 128; ++i) {
        const glm::dvec2 c = scenes::unit_circle(i * 0.381966);
        const double z = i % 4 == 0 ? -1 - 3.9 * i / 128 : -5.02 - 5 * i;
        // The first triangle holds a circle of radius 0.05 at z = -5 and is held by one of 0.1.
        const double grown = type == Light::Type::point ? -z / 5 : 1;
        ask(scene, {0.04 * grown * c, z}, i % 4 == 0 ? lit : shadowed);
        ask(scene, {(0.11 + 0.001 * i) * grown * c, z}, lit);
    }
    return {scene};
}

Scenes closed_and_cancelling(Light::Type type) {
    Scene closed = make_scene("tetrahedra", either_light(type, kOrigin, kDown));
    Scene cancelling = make_scene("opposite normals", closed.light);
    scenes::Random random(22);
    for (int i = 0; i < 16; ++i) {
        const glm::dvec3 center(i % 4 - 1.5, -3, i / 4 - 1.5);
        const auto corner = [&](double x, double y, double z) {
            return center + 0.2 * glm::dvec3(x, y, z);
        };
        const glm::dvec3 c[] = {corner(1, 1, 1), corner(1, -1, -1), corner(-1, 1, -1),
                                corner(-1, -1, 1)};
        for (int skip = 0; skip < 4; ++skip)
            add_triangle(closed.mesh, c[(skip + 1) % 4], c[(skip + 2) % 4], c[(skip + 3) % 4]);
        // A triangle and its copy wound the other way, and next to them a roof of two slopes.
        add_triangle(cancelling.mesh, corner(-1, 0, -1), corner(1, 0, -1), corner(0, 0, 1));
        add_triangle(cancelling.mesh, corner(0, 0, 1), corner(1, 0, -1), corner(-1, 0, -1));
        add_triangle(cancelling.mesh, corner(1.5, -2, -1), corner(1.5, -2, 1), corner(2, 0, 0));
        add_triangle(cancelling.mesh, corner(2, 0, 0), corner(2.5, -2, -1), corner(2.5, -2, 1));
        for (int k = 0; k < 16; ++k) {
            const glm::dvec3 q = center + 0.05 * random.uniform() * random.direction();
            ask(closed, behind(closed.light, q, 2), shadowed);
            ask(cancelling, behind(closed.light, glm::dvec3(q.x, -3, q.z), 2), shadowed);
        }
    }
    return {closed, cancelling};
}

Scenes spokes(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    scenes::Random random(24);
    const glm::dvec3 center(0, -5, 0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 u = random.direction();
        const glm::dvec3 v = glm::normalize(glm::cross(u, random.direction()));
        glm::dvec3 corners[3];  // about the center, in a plane of its own
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 c = 2.0 * scenes::unit_circle(k / 3.0);
            corners[k] = center + c.x * u + c.y * v;
        }
        add_triangle(scene.mesh, corners[0], corners[1], corners[2]);
    }
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 d = random.direction();
        const glm::dvec2 c = scenes::unit_circle(i / 64.0);
        ask(scene, behind(scene.light, center + 0.3 * random.uniform() * d, 3), shadowed);
        ask(scene, center + 2.2 * random.uniform() * d, unsaid);
        ask(scene, behind(scene.light, center + glm::dvec3(2 * c.x, 0, 2 * c.y), 1.6), unsaid);
        ask(scene, behind(scene.light, center + glm::dvec3(4 * c.x, 0, 4 * c.y), 2), lit);
    }
    return {scene};
}

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

using Corners = std::array<glm::dvec3, 3>;

/// Two equal corners, or all on a line through the origin, by factors that do not round.
void flatten(Corners& corners, int i) {
    corners[2] = i % 2 ? corners[1] : 2.0 * glm::dvec3(glm::vec3(corners[0]));
    if (i % 2 == 0) corners[1] = 0.25 * corners[2];
}

/// In one coordinate of one, two or all corners, of either sign.
void put_in(double value, Corners& corners, int i) {
    for (int k = 0; k <= i % 3; ++k) corners[k][(i + k) % 3] = i % 4 < 2 ? value : -value;
}

}  // namespace

Scenes broken_triangles(Light::Type type) {
    struct Fault {
        const char* name;
        void (*spoil)(Corners& corners, int i);
    };
    Scenes scenes;
    for (const Fault& fault :
         {Fault{"no area", flatten},
          Fault{"NaN", [](Corners&corners, int i) { put_in(kNan, corners, i); }},
          Fault{"infinity", [](Corners&corners, int i) { put_in(kInf, corners, i); }}}) {
        Scene scene = make_scene(fault.name, either_light(type, kOrigin, kDown));
        const std::uint32_t floor = add_floor(scene.mesh, {0, -3, 0}, 5);
        add_closed_box(scene.mesh, {-0.5, -2.2, -0.5}, {0.5, -1.8, 0.5});
        scene.essential = scene.mesh.triangle_count();
        scenes::Random random(26);
        for (int i = 0; i < 60; ++i) {
            Corners corners;
            for (glm::dvec3& corner : corners)
                corner = glm::dvec3(0, -1, 0) + random.uniform(0, 3) * random.direction();
            fault.spoil(corners, i);
            add_triangle(scene.mesh, corners[0], corners[1], corners[2]);
        }
        const bool point = type == Light::Type::point;
        for (int i = 0; i < 256; ++i) {
            const double x = (i % 16 - 7.6) * 0.25, z = (i / 16 - 7.5) * 0.25;
            const double reach = std::max(std::abs(x), std::abs(z));
            ask(scene, {x, -3, z}, point ? by_reach(reach, 0.6, 0.9) : by_reach(reach, 0.45, 0.55),
                floor_at(floor, x, z));
        }
        scenes.push_back(scene);
    }
    return scenes;
}

}  // namespace experiments::stability
