// Stress tests about edges and vertices that triangles share: no light may leak through.
#include <algorithm>
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::stability {
namespace {

using enum Expected;

/// `steps` representable numbers away, axis by axis.
glm::vec3 neighbour(glm::vec3 p, glm::ivec3 steps) {
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < std::abs(steps[axis]); ++i)
            p[axis] = std::nextafter(p[axis], steps[axis] < 0 ? -HUGE_VALF : HUGE_VALF);
    return p;
}

struct Box {
    glm::dvec3 lower, upper;
};

/// Whether the open segment p + t d, 0 < t < 1 (or without end) meets the closed box: by slabs,
/// whose parameters are fractions of small integers and are compared as such.
bool meets(const Box& box, glm::dvec3 p, glm::dvec3 d, bool endless) {
    struct Fraction {
        double over, under;  // under > 0
        bool operator<(const Fraction& other) const {
            return over * other.under < other.over * under;
        }
    };
    Fraction enter{-1e6, 1}, leave{1e6, 1};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.lower[axis] - p[axis], high = box.upper[axis] - p[axis];
        if (d[axis] == 0) {
            if (low > 0 || high < 0) return false;
        } else {
            const bool up = d[axis] > 0;
            enter = std::max(enter, Fraction{up ? low : -high, std::abs(d[axis])});
            leave = std::min(leave, Fraction{up ? high : -low, std::abs(d[axis])});
        }
    }
    return !(leave < enter) && leave.over > 0 && (endless || enter.over < enter.under);
}

}  // namespace

Scenes quad_diagonal(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    add_floor(scene.mesh, {0, -3, 0}, 1);
    for (int i = 0; i < 256; ++i) {
        const double t = -1.2 + 2.4 * i / 255;
        ask(scene, behind(scene.light, {t, -3, t}, 2), by_reach(std::abs(t), 0.98, 1.02));
    }
    return {scene};
}

Scenes fan_vertex(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    const glm::dvec3 hub = glm::vec3(0.1f, -3, 0.2f);
    const auto rim = [&](int i) {
        const glm::dvec2 c = scenes::unit_circle(i / 64.0),
                         wave = scenes::unit_circle(3 * i / 64.0);
        return hub + glm::dvec3(c.x, 0.25 * wave.y, c.y);
    };
    for (int i = 0; i < 64; ++i) add_triangle(scene.mesh, hub, rim(i), rim(i + 1));
    const glm::vec3 p = behind(scene.light, hub, 2);
    for (int i = 0; i < 6 * 6 * 6; ++i)
        ask(scene, neighbour(p, glm::ivec3(i % 6, i / 6 % 6, i / 36) - 3), shadowed);
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 outwards = rim(i) - hub;
        ask(scene, behind(scene.light, hub + 0.5 * outwards, 2), shadowed);
        ask(scene, behind(scene.light, hub + 1.5 * outwards, 2), lit);
    }
    return {scene};
}

Scenes integer_boxes(Light::Type type) {
    Scene scene = make_scene("", either_light(type, {1, 9, -2}, {1, -2, 1}));
    const Box boxes[] = {{{-3, 1, -2}, {-1, 2, 0}}, {{0, 1, 0}, {1, 4, 1}},
                         {{2, 2, -3}, {3, 3, 2}},   {{-2, 4, 2}, {2, 5, 3}},
                         {{-1, 6, -1}, {0, 7, 0}},  {{3, 1, 3}, {4, 2, 4}}};
    for (const Box& box : boxes) add_closed_box(scene.mesh, box.lower, box.upper);
    const bool directional = type == Light::Type::directional;
    const glm::dvec3 v = scene.light.vector;
    for (int i = 0; i < 512; ++i) {
        const glm::dvec3 p(0.5 * (i % 16) - 4, i / 256 * 3, 0.5 * (i / 16 % 16) - 4);
        const bool hit = std::any_of(std::begin(boxes), std::end(boxes), [&](const Box& box) {
            return meets(box, p, directional ? -v : v - p, directional);
        });
        ask(scene, p, hit ? shadowed : lit);
    }
    return {scene};
}

Scenes shared_edge(Light::Type type) {
    Scene scene = make_scene("", either_light(type, kOrigin, kDown));
    const glm::dvec3 a(0.3, -3, 0), b(0.3, -2.9, 1);
    add_triangle(scene.mesh, a, b, {-0.7, -3, 0.5});
    add_triangle(scene.mesh, b, a, {1.3, -2.95, 0.5});
    for (int i = 0; i < 256; ++i) {
        const glm::dvec3 q = a + (0.02 + 0.96 * i / 255) * (b - a);
        ask(scene, behind(scene.light, q, 2), shadowed);
    }
    return {scene};
}

Scenes wedge_mid_edge(Light::Type type) {
    // The plane z = 0 holds the light and an edge of the first triangle; the second one straddles
    // it, and the angle it spans above the plane is widest at its edge's middle.
    Scene scene = make_scene("", either_light(type, kOrigin, {1, 0.5f, 0}));
    add_triangle(scene.mesh, {3, -1, 0}, {3, 1, 0}, {3, 0, 0.5});
    const glm::dvec3 a(1, 0, 1), b(-0.5, std::sqrt(0.75), 1), c(0.2, 0.6, -0.5);
    add_triangle(scene.mesh, a, b, c);
    for (int i = 0; i < 16; ++i)
        for (int k = 0; k < 16; ++k) {
            const glm::dvec3 edge = a + (0.2 + 0.6 * i / 15) * (b - a);
            const double inwards = k == 0 ? 0 : 0.005 * std::pow(1.3, k);
            ask(scene, behind(scene.light, edge + inwards * (c - edge), 4),
                k == 0 ? unsaid : shadowed);
        }
    return {scene};
}

Scenes single_sheet(Light::Type type) {
    struct Winding {
        const char* name;
        bool (*turned)(int triangle);
    };
    Scenes scenes;
    for (const Winding& winding :
         {Winding{"clockwise", [](int) { return false; }},
          Winding{"counter-clockwise", [](int) { return true; }},
          Winding{"mixed", [](int triangle) { return triangle % 4 == 1 || triangle % 4 == 2; }}}) {
        Scene scene =
            make_scene(winding.name, either_light(type, {0.5f, 0, 0.25f}, {0.25f, -1, 0.125f}));
        for (int i = 0; i < 25; ++i)
            scene.mesh.positions.emplace_back(i % 5 - 2, -3 + 0.125 * (i % 3), i / 5 - 2);
        for (int cell = 0; cell < 16; ++cell) {
            const std::uint32_t at = cell / 4 * 5 + cell % 4;
            scene.mesh.triangles.emplace_back(at, at + 1, at + 6);
            scene.mesh.triangles.emplace_back(at, at + 6, at + 5);
        }
        for (int t = 0; t < 32; ++t)
            if (winding.turned(t)) std::swap(scene.mesh.triangles[t].y, scene.mesh.triangles[t].z);
        // On vertices, edges and faces of the sheet, away from its border.
        for (std::uint32_t t = 0; t < 32; ++t)
            for (int k = 0; k < 8; ++k) {
                const double weights[8][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 0},
                                              {0, 2, 2}, {2, 0, 2}, {1, 1, 1}, {4, 1, 1}};
                const double* w = weights[k];
                glm::dvec3 q(0);
                for (int c = 0; c < 3; ++c)
                    q += w[c] / (w[0] + w[1] + w[2]) * glm::dvec3(scene.mesh.corner(t, c));
                const bool border = std::max(std::abs(q.x), std::abs(q.z)) == 2;
                ask(scene, behind(scene.light, q, 2), border ? unsaid : shadowed);
            }
        scenes.push_back(scene);
    }
    return scenes;
}

}  // namespace experiments::stability
