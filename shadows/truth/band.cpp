// Lower bounds of distances to planar convex sets.
//
// The distance from p to such a set is that to its plane where p's projection lies inside, else
// that to its boundary. Vectors are differences of floats in double precision, each component off
// by a factor 1 + d, |d| <= 2^-53; so a normal n = v x w is off by at most 2^-50 |v| |w|, its
// direction by 2^-50 k with k = |v| |w| / |n|, and everything measured along or across it, over a
// reach r, by less than 2^-47 k r. If rounding takes an inside projection for an outside one, it
// lies within that distance of the boundary, and the distance to the boundary is right to within
// the same. Hence both cases are low enough after subtracting 2^-46 k r ("first bound").
//
// Where k is huge the set is thin, seen in its plane: all its points are within some width of the
// boundary, and distance to the boundary minus width is the better bound ("second bound").
// Distances to segments and rays need no normal; they err by less than 2^-47 r.
#include "shadows/truth/band.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace shadows::truth {
namespace {

using glm::dvec3;
using structures::geometry::Light;

constexpr double kPlaneError = 0x1p-46, kLineError = 0x1p-47;

dvec3 difference(glm::vec3 a, glm::vec3 b) { return dvec3(a) - dvec3(b); }

/// From the origin to {start + t along : 0 <= t <= end}.
double line_distance(const dvec3& start, const dvec3& along, double end) {
    const double size = glm::dot(along, along);
    const double t = size > 0 ? std::clamp(-glm::dot(start, along) / size, 0.0, end) : 0.0;
    return glm::length(start + t * along);
}

double ray_distance(const dvec3& start, const dvec3& along) {
    return line_distance(start, along, std::numeric_limits<double>::infinity());
}

}  // namespace

double triangle_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    // The corner opposite the longest edge has the angle farthest from 0: it comes first.
    const std::array<glm::vec3, 3> corners{a, b, c};
    std::array<double, 3> opposite;
    for (int i = 0; i < 3; ++i)
        opposite[i] = glm::length(difference(corners[(i + 2) % 3], corners[(i + 1) % 3]));
    const auto first =
        static_cast<int>(std::max_element(opposite.begin(), opposite.end()) - opposite.begin());
    const glm::vec3 &p0 = corners[first], &p1 = corners[(first + 1) % 3],
                    &p2 = corners[(first + 2) % 3];

    const dvec3 to[3] = {difference(p0, p), difference(p1, p), difference(p2, p)};
    const dvec3 edge[3] = {difference(p1, p0), difference(p2, p1), difference(p0, p2)};
    const double reach = glm::length(to[0]) + opposite[first];
    double boundary = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) boundary = std::min(boundary, line_distance(to[i], edge[i], 1));

    const dvec3 normal = glm::cross(edge[2], edge[0]);  // of (p0 - p2) x (p1 - p0)
    const double size = glm::length(normal);
    const double height = size / opposite[first];
    const double second = boundary - height - kLineError * reach;
    if (!(size > 0)) return std::max(0.0, second);
    const double condition = glm::length(edge[2]) * glm::length(edge[0]) / size;
    bool inside = true;
    for (int i = 0; i < 3; ++i)
        inside = inside && glm::dot(glm::cross(normal, edge[i]), -to[i]) >= 0;
    const double distance = inside ? std::abs(glm::dot(normal, to[0])) / size : boundary;
    return std::max({0.0, distance - kPlaneError * condition * reach, second});
}

double shadow_quad_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, const Light& light,
                            double limit) {
    // The quad has corners a and b and runs on without end along `from_a` and `from_b`. Seen from a
    // point light, the nearer corner gives the better normal.
    const bool directional = light.type == Light::Type::directional;
    dvec3 from_a(light.vector), from_b(light.vector);
    if (!directional) {
        from_a = difference(a, light.vector);
        from_b = difference(b, light.vector);
        if (glm::dot(from_a, from_a) > glm::dot(from_b, from_b)) {
            std::swap(a, b);
            std::swap(from_a, from_b);
        }
    }
    const dvec3 edge = difference(b, a), to_a = difference(a, p), to_b = difference(b, p);
    const dvec3 normal = glm::cross(from_a, edge);
    const double size = glm::length(normal), edge_length = glm::length(edge);
    const double reach = glm::length(to_a) + edge_length;
    double first = 0;
    bool inside = true;
    double plane_error = 0;
    if (size > 0) {
        plane_error = kPlaneError * reach * glm::length(from_a) * edge_length / size;
        first = std::abs(glm::dot(normal, to_a)) / size - plane_error;
        if (first > limit) return first;
        inside = glm::dot(glm::cross(normal, from_a), to_a) <= 0 &&
                 glm::dot(glm::cross(from_b, normal), to_b) <= 0 &&
                 glm::dot(glm::cross(edge, normal), to_a) <= 0;
    }
    if (inside && plane_error < kLineError * 0x1p20 * reach && size > 0)
        return std::max(0.0, first);

    const double boundary = std::min(
        {line_distance(to_a, edge, 1), ray_distance(to_a, from_a), ray_distance(to_b, from_b)});
    if (size > 0 && !inside) first = boundary - plane_error;
    // Second bound. Directional: the quad is size / |vector| wide. Point light, seen from which the
    // edge spans an angle w < pi/2: the circle about L through a point x of the quad leaves the
    // quad within w |x|; so boundary <= d + w |x| <= d + w (|p - L| + d).
    double second = 0;
    const double line_error = kLineError * (reach + glm::length(from_a));
    if (directional) {
        second = boundary - size / glm::length(from_a) - line_error;
    } else if (glm::dot(from_a, from_b) > 0) {
        const double angle = 1.6 * size / (glm::length(from_a) * glm::length(from_b));
        const double away = glm::length(difference(p, light.vector));
        second = (boundary - angle * away) / (1 + angle) - line_error;
    }
    return std::max({0.0, first, second});
}

}  // namespace shadows::truth
