// Random scenes for the judge's tests: soups, meshes, awkward lights, points near all of it; and
// the judge asked about one point.
#pragma once

#include <cmath>
#include <random>

#include "shadows/truth/truth.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using Random = std::mt19937;

inline float uniform(Random& random, float lower, float upper) {
    return std::uniform_real_distribution<float>(lower, upper)(random);
}

inline glm::vec3 in_cube(Random& random, float side) {
    const float x = uniform(random, -side, side), y = uniform(random, -side, side);
    return {x, y, uniform(random, -side, side)};
}

/// Triangles of all shapes: plain ones, slivers, ones with corners on an integer grid, ones that
/// share corners with earlier ones.
inline TriangleMesh soup(Random& random, std::uint32_t count) {
    TriangleMesh mesh;
    const auto corner = [&](glm::vec3 at, float size, bool grid) {
        if (!mesh.positions.empty() && random() % 4 == 0)
            return static_cast<std::uint32_t>(random() % mesh.positions.size());
        const glm::vec3 v = at + in_cube(random, size);
        mesh.positions.push_back(grid ? glm::round(v * 4.0f) / 4.0f : v);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 at = in_cube(random, 1);
        const float size = std::pow(10.0f, uniform(random, -2, 0));
        const bool grid = random() % 3 == 0;
        glm::uvec3 triangle{corner(at, size, grid), corner(at, size, grid), 0};
        triangle.z = random() % 8 == 0 ? corner(mesh.positions[triangle.x], 1e-6f, false)
                                       : corner(at, size, grid);
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// A closed, consistently wound ball of 4 * rings * rings triangles.
inline TriangleMesh ball(glm::vec3 center, float radius, std::uint32_t rings) {
    TriangleMesh mesh;
    const std::uint32_t around = 2 * rings;
    const auto vertex = [&](std::uint32_t ring, std::uint32_t step) {
        return ring == 0 ? 0 : ring == rings ? 1 : 2 + (ring - 1) * around + step % around;
    };
    const auto at = [&](double polar, double turn) {
        return center + radius * glm::vec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                           std::sin(polar) * std::sin(turn));
    };
    constexpr double kPi = 3.14159265358979323846;
    mesh.positions = {at(0, 0), at(kPi, 0)};
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t step = 0; step < around; ++step)
            mesh.positions.push_back(at(kPi * ring / rings, 2 * kPi * step / around));
    for (std::uint32_t ring = 0; ring < rings; ++ring)
        for (std::uint32_t step = 0; step < around; ++step) {
            if (ring + 1 < rings)
                mesh.triangles.push_back(
                    {vertex(ring, step), vertex(ring + 1, step + 1), vertex(ring + 1, step)});
            if (ring > 0)
                mesh.triangles.push_back(
                    {vertex(ring, step), vertex(ring, step + 1), vertex(ring + 1, step + 1)});
        }
    return mesh;
}

/// A flat floor at height y, [-side, side] squared, in cells * cells squares of two triangles.
inline TriangleMesh floor_mesh(float side, float y, std::uint32_t cells) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i)
            mesh.positions.push_back({side * (2.0f * float(i) / float(cells) - 1), y,
                                      side * (2.0f * float(j) / float(cells) - 1)});
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t v = j * (cells + 1) + i, w = v + cells + 1;
            mesh.triangles.push_back({v, w, v + 1});
            mesh.triangles.push_back({v + 1, w, w + 1});
        }
    return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const glm::uvec3& t : other.triangles) mesh.triangles.push_back(t + base);
}

/// In free space, near a corner, an edge or a face of some triangle, or exactly on a corner.
inline glm::vec3 awkward_place(Random& random, const TriangleMesh& mesh) {
    if (mesh.triangles.empty() || random() % 4 == 0) return in_cube(random, 1.5f);
    const std::size_t t = random() % mesh.triangle_count();
    float u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (random() % 3 == 0) v = 0;
    if (random() % 5 == 0) u = v = 0;
    const glm::vec3 a = mesh.corner(t, 0);
    return a + u * (mesh.corner(t, 1) - a) + v * (mesh.corner(t, 2) - a);
}

inline Light random_light(Random& random, const TriangleMesh& mesh) {
    if (random() % 2) return {Light::Type::point, 2.0f * awkward_place(random, mesh)};
    glm::vec3 direction = in_cube(random, 1);
    if (random() % 3 == 0) direction = glm::vec3(0, -1, 0);
    if (random() % 3 == 0) direction = glm::round(2.0f * direction);
    if (direction == glm::vec3(0)) direction.z = 1;
    return {Light::Type::directional, direction};
}

struct Place {
    glm::vec3 p;
    std::uint32_t own;
};

/// A point on a triangle (its own), or in free space.
inline Place random_place(Random& random, const TriangleMesh& mesh) {
    if (mesh.triangles.empty() || random() % 3 == 0)
        return {awkward_place(random, mesh), shadows::kNoReceiver};
    const auto t = static_cast<std::uint32_t>(random() % mesh.triangle_count());
    float u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (random() % 4 == 0) v = 0;
    const glm::vec3 a = mesh.corner(t, 0);
    return {a + u * (mesh.corner(t, 1) - a) + v * (mesh.corner(t, 2) - a), t};
}

/// A point a few epsilons from the shadow quad of some edge, on no triangle or on one of the
/// edge's.
inline Place place_near_shadow(Random& random, const TriangleMesh& mesh, const Light& light) {
    if (mesh.triangles.empty()) return {in_cube(random, 1), shadows::kNoReceiver};
    const auto t = static_cast<std::uint32_t>(random() % mesh.triangle_count());
    const int k = static_cast<int>(random() % 3);
    const glm::vec3 a = mesh.corner(t, k), b = mesh.corner(t, (k + 1) % 3);
    const glm::vec3 x = a + (random() % 4 ? uniform(random, 0, 1) : 0.0f) * (b - a);
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3 p = x + uniform(random, 0, 2) * (directional ? light.vector : x - light.vector);
    const float size = glm::length(p) + glm::length(light.vector) + 1;
    const glm::vec3 offset = in_cube(random, 1e-5f * std::pow(2.0f, uniform(random, -2, 5)) * size);
    return {p + (random() % 4 ? offset : glm::vec3(0)), random() % 3 ? shadows::kNoReceiver : t};
}

/// The places in their order, not padded to tiles as an image is.
inline shadows::PointArrays to_points(const std::vector<Place>& places,
                                      glm::vec3 normal = glm::vec3(0)) {
    shadows::PointArrays points;
    for (const Place& place : places) {
        points.x.push_back(place.p.x);
        points.y.push_back(place.p.y);
        points.z.push_back(place.p.z);
        points.primitive.push_back(place.own);
        points.normal.push_back(normal);
    }
    return points;
}

/// The verdict on one place.
inline shadows::truth::Verdict judge(const shadows::truth::Truth& truth, const Place& place,
                                     glm::vec3 normal = glm::vec3(0)) {
    return truth.judge(to_points({place}, normal), {.threads = 1}).points[0];
}

}  // namespace tests
