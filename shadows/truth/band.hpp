// Distances that decide whether a point is ambiguous, in double precision and never too large.
//
//     double d = triangle_distance(p, a, b, c);
//     double s = shadow_quad_distance(p, a, b, light, limit);
//
// Each returns a lower bound of the true distance. It falls short of it by no more than 2^-45 of
// the sizes involved, unless the plane of the triangle or quad is nearly undefined (its spanning
// vectors parallel to within 2^-20 or so), where two bounds compete: see band.cpp.
#pragma once

#include <glm/glm.hpp>

#include "structures/geometry/light.hpp"

namespace shadows::truth {

/// From p to the closed triangle a, b, c, whose corners are not all one.
double triangle_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c);

/// From p to the part of the plane through the light and the edge a, b that lies on or behind the
/// edge: {L + t (X - L) : X on the edge, t >= 1}, or {X + t vector : t >= 0} for a directional
/// light. If it is more than `limit`, any number greater than `limit` may be returned.
double shadow_quad_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b,
                            const structures::geometry::Light& light, double limit);

}  // namespace shadows::truth
