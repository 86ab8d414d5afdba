// Shadow rays by testing every triangle in double precision, with a margin that tells sure answers
// from close calls; and random points on a mesh to ask about.
#pragma once

#include <random>

#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

enum class Answer { lit, shadowed, close_call };

/// Whether a triangle other than `receiver` meets the open segment from `p` to the light (Moeller
/// and Trumbore 1997, "Fast, minimum storage ray/triangle intersection"). A close call: some
/// triangle is hit or missed by less than `margin` in barycentric coordinates or in the segment's
/// parameter, or the light grazes the receiver.
inline Answer brute_force(const structures::geometry::TriangleMesh& mesh,
                          const structures::geometry::Light& light, glm::vec3 p,
                          std::uint32_t receiver, double margin = 1e-4) {
    const bool directional = light.type == structures::geometry::Light::Type::directional;
    const glm::dvec3 origin = p;
    // For a directional light long enough to leave any scene of the tests.
    const glm::dvec3 ray = directional ? -100.0 * glm::normalize(glm::dvec3(light.vector))
                                       : glm::dvec3(light.vector) - origin;
    bool shadowed = false, close = false;
    for (std::uint32_t id = 0; id < mesh.triangle_count(); ++id) {
        const glm::dvec3 a = mesh.corner(id, 0), ab = glm::dvec3(mesh.corner(id, 1)) - a,
                         ac = glm::dvec3(mesh.corner(id, 2)) - a;
        const glm::dvec3 normal = glm::cross(ab, ac);
        const double det = -glm::dot(ray, normal);
        const double cosine = det / (glm::length(ray) * glm::length(normal));
        if (mesh.degenerate(id)) continue;
        if (id == receiver) {
            close |= std::abs(cosine) < 0.02;
            continue;
        }
        const glm::dvec3 ao = origin - a, dao = glm::cross(ao, ray);
        const double u = glm::dot(ac, dao) / det, v = -glm::dot(ab, dao) / det;
        const double t = glm::dot(ao, normal) / det;
        const double inside = std::min({u, v, 1 - u - v, t, 1 - t});
        if (inside > margin && std::abs(cosine) > 1e-4) shadowed = true;
        if (!(std::abs(inside) > margin) || std::abs(cosine) <= 1e-4) close = true;
    }
    return shadowed ? Answer::shadowed : close ? Answer::close_call : Answer::lit;
}

/// Points at random places of random triangles, with every tenth point left without geometry.
inline shadows::PointArrays random_points(const structures::geometry::TriangleMesh& mesh,
                                          std::uint32_t width, std::uint32_t height,
                                          std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto tiles = [](std::uint32_t side) {
        return (side + shadows::kTileSide - 1) / shadows::kTileSide;
    };
    const std::size_t count = std::size_t{tiles(width)} * tiles(height) * shadows::kTilePoints;
    shadows::PointArrays points;
    for (std::vector<float>* plane : {&points.x, &points.y, &points.z}) plane->resize(count);
    points.primitive.assign(count, shadows::kNoPrimitive);
    points.normal.resize(count);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (mesh.triangles.empty() || random() % 10 == 0) continue;
            const auto id = static_cast<std::uint32_t>(random() % mesh.triangle_count());
            if (mesh.degenerate(id)) continue;
            float u = unit(random), v = unit(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const glm::vec3 a = mesh.corner(id, 0), b = mesh.corner(id, 1), c = mesh.corner(id, 2);
            const glm::vec3 p = a + u * (b - a) + v * (c - a);
            const std::uint32_t i = shadows::point_index(x, y, width);
            points.x[i] = p.x;
            points.y[i] = p.y;
            points.z[i] = p.z;
            points.primitive[i] = id;
            points.normal[i] = glm::normalize(glm::cross(b - a, c - a));
        }
    return points;
}

}  // namespace tests
