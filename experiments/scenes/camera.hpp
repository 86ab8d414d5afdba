// A pinhole camera, and a view: a camera with a light.
//
//     Camera camera{{0, 4, 8}, {0, 1, 0}, {0, 1, 0}, 60};
//     mat4 clip_from_world = camera.view_projection(16.f / 9, 0.01f);   // Vulkan, reverse-Z
//     PixelRay ray = camera.pixel_ray(0, 0, 1920, 1080);                // through the top left
//     pixel
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "structures/geometry/aabb.hpp"
#include "structures/geometry/light.hpp"

namespace experiments::scenes {

struct PixelRay {
    glm::vec3 origin;
    glm::vec3 direction;  ///< unit length
};

struct Camera {
    glm::vec3 eye{0, 0, 1};
    glm::vec3 target{0, 0, 0};
    glm::vec3 up{0, 1, 0};  ///< any direction but that of view
    float fov_y_degrees = 45;

    /// World space to Vulkan clip space (y down, depth 0 to 1) with reversed depth and no far
    /// plane: depth is `near` / distance along the view, 1 at the near plane, towards 0 far away.
    /// `aspect` is width / height, `near` a distance greater than 0.
    glm::mat4 view_projection(float aspect, float near) const;
    /// The ray from the eye through the centre of pixel (x, y), (0, 0) at the top left.
    PixelRay pixel_ray(int x, int y, int width, int height) const;
    /// What makes this camera unusable ("eye and target are the same point", ...), or empty.
    std::string fault() const;
    bool operator==(const Camera&) const = default;
};

struct View {
    Camera camera;
    structures::geometry::Light light;
    bool operator==(const View&) const = default;
};

/// The view for a mesh that comes with none: the camera looks at the centre of `bounds` from the
/// front right (+x, +z) and above, about 24 degrees up, y upward, far enough for the bounding
/// sphere to fit a 45 degree field of view; a point light hangs to the front left above it, two
/// bounding radii away. A box without extent is taken to have a small one.
View default_view(const structures::geometry::Aabb& bounds);

}  // namespace experiments::scenes
