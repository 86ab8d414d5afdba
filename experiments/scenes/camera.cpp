// Cameras: projection, rays, checks, and the default view.
#include "experiments/scenes/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments::scenes {
namespace {

struct Frame {
    glm::dvec3 right, up, forward;
};

/// Computed in double precision: nothing is lost where eye and target are large and close.
Frame frame_of(const Camera& camera) {
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.eye));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
    return {right, glm::cross(right, forward), forward};
}

double half_height(const Camera& camera) {
    return std::tan(glm::radians(static_cast<double>(camera.fov_y_degrees)) / 2);
}

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

glm::mat4 Camera::view_projection(float aspect, float near) const {
    const Frame frame = frame_of(*this);
    const double scale_y = 1 / half_height(*this);
    const glm::dvec3 from(eye);
    const auto row = [&](glm::dvec3 axis) { return glm::dvec4(axis, -glm::dot(axis, from)); };
    glm::dmat4 rows;  // transposed below
    rows[0] = scale_y / aspect * row(frame.right);
    rows[1] = -scale_y * row(frame.up);
    rows[2] = glm::dvec4(0, 0, 0, near);
    rows[3] = row(frame.forward);
    return glm::transpose(rows);
}

PixelRay Camera::pixel_ray(int x, int y, int width, int height) const {
    const Frame frame = frame_of(*this);
    const double size = half_height(*this);
    const double across = (2 * (x + 0.5) / width - 1) * size * width / height;
    const double down = (2 * (y + 0.5) / height - 1) * size;
    return {eye, glm::normalize(frame.forward + across * frame.right - down * frame.up)};
}

std::string Camera::fault() const {
    if (!finite(eye) || !finite(target) || !finite(up))
        return "eye, target and up must be finite numbers";
    if (eye == target) return "eye and target are the same point";
    const glm::dvec3 forward = glm::dvec3(target) - glm::dvec3(eye);
    if (up == glm::vec3(0)) return "up has no length";
    // Below this sine of the angle between them the image's orientation is rounding noise.
    constexpr double kMinSine = 1e-6;
    if (glm::length(glm::cross(glm::normalize(forward), glm::normalize(glm::dvec3(up)))) < kMinSine)
        return "up points along the view";
    if (!(fov_y_degrees > 0 && fov_y_degrees < 180))
        return fmt::format("fov_y_degrees is {}, not between 0 and 180", fov_y_degrees);
    return {};
}

View default_view(const structures::geometry::Aabb& bounds) {
    const glm::vec3 center = bounds.empty() ? glm::vec3(0) : bounds.center();
    const glm::vec3 magnitude = glm::abs(center);
    // A lower limit keeps eye and target apart where the box is a point, or tiny and far out.
    constexpr float kMinRelative = 1e-4f, kMinRadius = 1e-12f;
    const float radius =
        std::max({glm::length(0.5f * bounds.extent()), kMinRadius,
                  kMinRelative * std::max({magnitude.x, magnitude.y, magnitude.z})});
    constexpr float kFov = 45;
    const float distance = 1.05f * radius / std::sin(glm::radians(kFov / 2));
    View view;
    view.camera = {
        center + distance * glm::normalize(glm::vec3(0.6f, 0.52f, 1.f)), center, {0, 1, 0}, kFov};
    view.light = {structures::geometry::Light::Type::point,
                  center + 2 * radius * glm::normalize(glm::vec3(-0.7f, 1.f, 0.5f))};
    return view;
}

}  // namespace experiments::scenes
