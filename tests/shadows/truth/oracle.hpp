// What the judge is judged by: rational arithmetic, every triangle, and distances in long double by
// other means than the judge's.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

/// Sign of det(a - o, b - o, c - o).
int rational_orientation(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o);
/// Sign of det(a - o, b - o, direction).
int rational_orientation_towards(glm::vec3 a, glm::vec3 b, glm::vec3 direction, glm::vec3 o);

/// The definition, literally: is p shadowed by a caster other than `own`?
bool shadowed_by_any(glm::vec3 p, std::uint32_t own, const structures::geometry::Light& light,
                     const structures::geometry::TriangleMesh& mesh);

using Real = long double;
using Vector = glm::vec<3, Real, glm::defaultp>;

/// From p to the triangle a, b, c.
Real distance_to_triangle(Vector p, Vector a, Vector b, Vector c);
/// From p to the shadow quad behind the edge a, b.
Real distance_to_quad(glm::vec3 p, glm::vec3 a, glm::vec3 b,
                      const structures::geometry::Light& light);
/// Distance of p from where the answer may change: shadow quads of edges that have a multiplicity
/// among the casters other than `own`, those casters, and the light's distance from them.
Real clearance(glm::vec3 p, std::uint32_t own, const structures::geometry::Light& light,
               const structures::geometry::TriangleMesh& mesh);

}  // namespace tests
