// The light of a shadow query.
#pragma once

#include <glm/glm.hpp>

namespace structures::geometry {

/// `point`: `vector` is the position. `directional`: `vector` is the direction in which light
/// travels (any length but zero), so a receiver p is lit along p - t * vector, t > 0.
struct Light {
    enum class Type { point, directional };
    Type type = Type::point;
    glm::vec3 vector{0, 0, 0};
    bool operator==(const Light&) const = default;
};

}  // namespace structures::geometry
