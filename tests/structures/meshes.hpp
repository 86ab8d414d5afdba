// Meshes, most of them seeded, that tests of structures and shadow methods share.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

using structures::geometry::TriangleMesh;

inline void add_triangle(TriangleMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Two triangles, a, b, c and a, c, d.
inline void add_quad(TriangleMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
}

/// Twelve triangles.
inline void add_box(TriangleMesh& mesh, glm::vec3 lower, glm::vec3 upper) {
    const auto corner = [&](int i) {
        return glm::vec3(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y,
                         i & 4 ? upper.z : lower.z);
    };
    const int quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& q : quads)
        add_quad(mesh, corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3]));
}

/// `count` separate triangles with edges of about `size` in the unit cube.
inline TriangleMesh random_triangles(std::size_t count, std::uint32_t seed, float size = 0.1f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1), offset(-size, size);
    TriangleMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 center(unit(random), unit(random), unit(random));
        const auto corner = [&] {
            return center + glm::vec3(offset(random), offset(random), offset(random));
        };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        add_triangle(mesh, a, b, c);
    }
    return mesh;
}

/// `count` copies of one triangle.
inline TriangleMesh identical_triangles(std::size_t count) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.triangles.assign(count, {0, 1, 2});
    return mesh;
}

/// A closed sphere of 2 * rings * sectors triangles, less the 2 * sectors degenerate ones at the
/// poles, which are left in.
inline TriangleMesh sphere(int rings, int sectors, glm::vec3 center, float radius) {
    TriangleMesh mesh;
    constexpr float kPi = 3.14159265f;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            const bool pole = r == 0 || r == rings;
            const float theta = kPi * r / rings, phi = pole ? 0 : 2 * kPi * s / sectors;
            mesh.positions.push_back(center +
                                     radius * glm::vec3(pole ? 0 : std::sin(theta) * std::cos(phi),
                                                        pole ? 0 : std::sin(theta) * std::sin(phi),
                                                        std::cos(theta)));
        }
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            const auto at = [&](int ring, int sector) {
                return static_cast<std::uint32_t>(ring * sectors + sector % sectors);
            };
            mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    return mesh;
}

}  // namespace tests
