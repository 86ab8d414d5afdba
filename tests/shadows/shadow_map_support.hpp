// Scenes and points for the tests of shadow maps, and which points a map can be right about.
#pragma once

#include <cmath>
#include <random>

#include "experiments/scenes/generators.hpp"
#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/occlusion.hpp"
#include "tests/support/points.hpp"

namespace tests::shadow_map {

using shadows::kNoPrimitive;
using shadows::kNoReceiver;
using shadows::PointArrays;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;

inline constexpr std::uint32_t kSide = 64;  ///< of an image of points
inline constexpr Light::Type kDirectional = Light::Type::directional;

struct Scene {
    TriangleMesh mesh;
    Light light;
    PointArrays points;
};

/// A square floor of half width `half` at height `y`, in 2 * n * n triangles.
inline void add_floor(TriangleMesh& mesh, float half, float y, int n = 1) {
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto at = [&](int a, int b) {
                return glm::vec3(half * (2.f * a / n - 1), y, half * (2.f * b / n - 1));
            };
            add_quad(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
        }
}

inline Scene box_over_floor(std::uint32_t seed = 1) {
    Scene scene;
    add_floor(scene.mesh, 10, 0, 8);
    add_box(scene.mesh, {-1, 1, -2}, {2, 2.5f, 1});
    scene.light.vector = {0.3f, 9, -0.7f};
    scene.points = random_points(scene.mesh, kSide, kSide, seed);
    return scene;
}

inline Scene generated(const char* name, std::int64_t triangles, std::uint32_t seed = 1) {
    for (const auto& row : experiments::scenes::generators()) {
        if (row.name != name) continue;
        const structures::Settings settings = structures::Settings::resolve(
            row.parameters(), {{"triangles", structures::Value(triangles)}});
        const experiments::scenes::GeneratedScene made = row.generate(settings);
        Scene scene{made.mesh, made.light, {}};
        scene.points = random_points(scene.mesh, kSide, kSide, seed);
        return scene;
    }
    throw std::invalid_argument(name);
}

inline Scene with_light(Scene scene, const Light& light) {
    scene.light = light;
    return scene;
}

/// Whether a triangle that does not lie in the plane through p comes within `distance` (judged by
/// its plane and its box).
inline bool crease_near(const TriangleMesh& mesh, glm::vec3 p, glm::vec3 normal, float distance) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        const structures::geometry::Aabb box = mesh.triangle_bounds(t);
        if (glm::distance(glm::clamp(p, box.lower, box.upper), p) > distance) continue;
        const glm::vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        const glm::vec3 across = glm::cross(b - a, c - a);
        if (std::abs(glm::dot(across, p - a)) > distance * glm::length(across)) continue;
        for (glm::vec3 corner : {a, b, c})
            if (std::abs(glm::dot(normal, corner - p)) > 1e-3f * distance) return true;
    }
    return false;
}

/// Whether point i is clear of silhouettes and creases: within `texels` texels of a map of that
/// resolution around it there is no other surface than its own plane, and that plane, with what
/// lies in front of it as far as it may rise over them, has the same answer: `lit`.
inline bool clear_of_edges(const Scene& scene, std::uint32_t i, std::uint32_t resolution,
                           float texels, bool& lit) {
    const glm::vec3 p = position(scene.points, i);
    const bool directional = scene.light.type == kDirectional;
    const glm::vec3 towards =
        directional ? -glm::normalize(scene.light.vector) : scene.light.vector - p;
    const glm::vec3 ray = glm::normalize(towards);
    const float reach =
        directional ? glm::length(scene.mesh.bounds().extent()) : 2 * glm::length(towards);
    const float step = texels * reach / float(resolution);
    const std::uint32_t own = scene.points.primitive[i];
    const glm::vec3 normal = own < kNoReceiver ? scene.points.normal[i] : ray;
    const float cosine = glm::dot(normal, ray);
    if (std::abs(cosine) < 0.15f) return false;
    const float rise = 1 + std::sqrt(1 - std::min(cosine * cosine, 1.f)) / std::abs(cosine);
    if (own < kNoReceiver && crease_near(scene.mesh, p, normal, rise * step)) return false;
    const glm::vec3 u = glm::normalize(
        glm::cross(ray, std::abs(ray.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(ray, u);
    lit = !tests::occluded(p, own, scene.light, scene.mesh);
    for (int k = 0; k < 8; ++k) {
        const float angle = 0.7853982f * float(k);
        const glm::vec3 offset = step * (std::cos(angle) * u + std::sin(angle) * v);
        const glm::vec3 on_plane = p + offset - glm::dot(normal, offset) / cosine * ray;
        // Far up, occluders that a bias may have moved behind the surface.
        for (float lift : {0.02f * rise * step, (rise + 8) * step})
            if (lit == tests::occluded(on_plane + lift * ray, own, scene.light, scene.mesh))
                return false;
    }
    return true;
}

}  // namespace tests::shadow_map
