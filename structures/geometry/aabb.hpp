// Axis-aligned box.
//
//     Aabb box;                       // empty: lower = +inf, upper = -inf
//     for (vec3 p : points) box.grow(p);
//     float area = box.half_area();   // 0 for an empty box
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace structures::geometry {

struct Aabb {
    glm::vec3 lower{std::numeric_limits<float>::infinity()};
    glm::vec3 upper{-std::numeric_limits<float>::infinity()};

    void grow(glm::vec3 point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void grow(const Aabb& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    bool contains(const Aabb& other) const {
        return glm::all(glm::lessThanEqual(lower, other.lower)) &&
               glm::all(glm::greaterThanEqual(upper, other.upper));
    }
    glm::vec3 extent() const { return empty() ? glm::vec3(0) : upper - lower; }
    glm::vec3 center() const { return 0.5f * lower + 0.5f * upper; }
    /// Half the surface area: the SAH needs ratios only.
    float half_area() const {
        const glm::vec3 e = extent();
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
    bool operator==(const Aabb&) const = default;
};

}  // namespace structures::geometry
