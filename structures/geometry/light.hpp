// The light of a shadow query.
//
//     Light light{Light::Type::directional, {0, -1, 0}};
//     require_usable(light);                            // finite, and not 0
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <stdexcept>

namespace structures::geometry {

/// `point`: `vector` is the position. `directional`: `vector` is the direction in which light
/// travels (any length but zero), so a receiver p is lit along p - t * vector, t > 0.
struct Light {
    enum class Type { point, directional };
    Type type = Type::point;
    glm::vec3 vector{0, 0, 0};
    bool operator==(const Light&) const = default;
};

/// Throws std::invalid_argument unless the light is finite and, if directional, has a direction.
inline void require_usable(const Light& light) {
    const glm::vec3& v = light.vector;
    const bool directional = light.type == Light::Type::directional;
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw std::invalid_argument(
            directional ? "the light's direction is not finite; give finite numbers"
                        : "the light's position is not finite; give finite numbers");
    if (directional && v == glm::vec3(0))
        throw std::invalid_argument("the light's direction is zero; give a vector of any length");
}

}  // namespace structures::geometry
