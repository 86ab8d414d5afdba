// Shadow rays by testing every triangle in double precision, with a margin that tells sure answers
// from close calls.
#pragma once

#include <algorithm>
#include <cmath>

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

}  // namespace tests
