// Indexed triangles in world space, single precision: the input of every structure and method.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "structures/geometry/aabb.hpp"

namespace structures::geometry {

/// `triangles[i]` holds three indices into `positions`. A primitive id is an index into
/// `triangles`. Loaders guarantee: indices in range, positions finite. Degenerate triangles (zero
/// area, repeated index, from elsewhere also corners that are not finite) may be present;
/// structures count them and leave them out.
struct TriangleMesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    std::size_t triangle_count() const { return triangles.size(); }
    glm::vec3 corner(std::size_t triangle, int k) const {
        return positions[triangles[triangle][k]];
    }
    Aabb triangle_bounds(std::size_t triangle) const {
        Aabb box;
        for (int k = 0; k < 3; ++k) box.grow(corner(triangle, k));
        return box;
    }
    /// True when the triangle has exactly no area in the input's own precision: two equal corners,
    /// or collinear ones (the double-precision cross product is 0); or a corner is not finite. The
    /// squares of what single precision leaves neither vanish nor overflow.
    bool degenerate(std::size_t triangle) const {
        const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double square = glm::dot(normal, normal);
        return !(square > 0 && square < std::numeric_limits<double>::infinity());
    }
    /// Of the triangles whose corners are finite.
    Aabb bounds() const {
        Aabb box;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const glm::dvec3 sum = glm::abs(glm::dvec3(corner(t, 0))) +
                                   glm::abs(glm::dvec3(corner(t, 1))) +
                                   glm::abs(glm::dvec3(corner(t, 2)));
            if (sum.x + sum.y + sum.z < std::numeric_limits<double>::infinity())
                box.grow(triangle_bounds(t));
        }
        return box;
    }
};

}  // namespace structures::geometry
