#include "experiments/stability/scene.hpp"

#include <cmath>

namespace experiments::stability {

Light point_light(glm::vec3 position) { return {Light::Type::point, position}; }

Light directional_light(glm::vec3 direction) { return {Light::Type::directional, direction}; }

Light either_light(Light::Type type, glm::vec3 position, glm::vec3 direction) {
    return type == Light::Type::point ? point_light(position) : directional_light(direction);
}

Scene make_scene(std::string name, const Light& light) {
    Scene scene;
    scene.name = std::move(name);
    scene.light = light;
    return scene;
}

glm::dvec3 behind(const Light& light, glm::dvec3 q, double times) {
    const glm::dvec3 v = light.vector;
    if (light.type == Light::Type::point) return v + times * (q - v);
    return q + (times - 1) * 4 * glm::normalize(v);
}

glm::dvec3 on_height(const Light& light, glm::dvec3 q, double y) {
    const glm::dvec3 v = light.vector;
    const glm::dvec3 along = light.type == Light::Type::point ? q - v : v;
    return q + (y - q.y) / along.y * along;
}

void ask(Scene& scene, glm::dvec3 position, Expected expected, std::uint32_t receiver) {
    scene.points.push_back({glm::vec3(position), receiver, expected});
}

void add_triangle(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec3& p : {a, b, c}) mesh.positions.emplace_back(p);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
}

std::uint32_t add_floor(TriangleMesh& mesh, glm::dvec3 center, double half_side) {
    const auto corner = [&](int x, int z) { return center + half_side * glm::dvec3(x, 0, z); };
    scenes::add_quad(mesh, {corner(-1, -1), corner(-1, 1), corner(1, 1), corner(1, -1)});
    return static_cast<std::uint32_t>(mesh.triangle_count() - 2);
}

std::uint32_t floor_at(std::uint32_t first, double x, double z) {
    return z >= x ? first : first + 1;
}

void add_closed_box(TriangleMesh& mesh, glm::dvec3 lower, glm::dvec3 upper) {
    scenes::add_box(mesh, lower, upper);
    scenes::add_quad(mesh, {glm::dvec3(lower.x, lower.y, lower.z),
                            {upper.x, lower.y, lower.z},
                            {upper.x, lower.y, upper.z},
                            {lower.x, lower.y, upper.z}});
}

void add_cable(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, double radius, std::size_t sides) {
    const glm::dvec3 axis = glm::normalize(b - a);
    const scenes::Ring rings[] = {{a, axis, radius}, {b, axis, radius}};
    scenes::add_tube(mesh, rings, sides);
}

void add_capsule(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, double radius, std::size_t sides) {
    const glm::dvec3 axis = glm::normalize(b - a);
    std::vector<scenes::Ring> rings;
    for (const double turns : {0.02, 0.08, 0.16, 0.25}) {
        const glm::dvec2 slope = radius * scenes::unit_circle(turns);
        rings.push_back({a - slope.x * axis, axis, slope.y});
    }
    for (const double turns : {0.25, 0.16, 0.08, 0.0}) {
        const glm::dvec2 slope = radius * scenes::unit_circle(turns);
        rings.push_back({b + slope.x * axis, axis, slope.y});
    }
    scenes::add_tube(mesh, rings, sides);
}

Image make_image(const Scene& scene) {
    constexpr std::uint32_t kTile = shadows::kTilePoints, kSide = shadows::kTileSide;
    const std::size_t tiles = std::max<std::size_t>(1, (scene.points.size() + kTile - 1) / kTile);
    Image image;
    image.height = static_cast<std::uint32_t>(tiles) * kSide;
    shadows::PointArrays& arrays = image.arrays;
    for (std::vector<float>* plane : {&arrays.x, &arrays.y, &arrays.z})
        plane->assign(tiles * kTile, 0.0f);
    arrays.primitive.assign(tiles * kTile, shadows::kNoPrimitive);
    arrays.normal.assign(tiles * kTile, glm::vec3(0, 0, 1));
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
        const ScenePoint& point = scene.points[i];
        const std::uint32_t at = place_in_image(i);
        arrays.x[at] = point.position.x;
        arrays.y[at] = point.position.y;
        arrays.z[at] = point.position.z;
        arrays.primitive[at] = point.receiver;
        // Whoever looks at a point does so from its lit side: no point counts as facing away.
        glm::dvec3 towards = scene.light.vector;
        towards = scene.light.type == Light::Type::point ? towards - glm::dvec3(point.position)
                                                         : -towards;
        glm::dvec3 normal = towards;
        if (point.receiver < scene.mesh.triangle_count()) {
            const glm::dvec3 a = scene.mesh.corner(point.receiver, 0);
            normal = glm::cross(glm::dvec3(scene.mesh.corner(point.receiver, 1)) - a,
                                glm::dvec3(scene.mesh.corner(point.receiver, 2)) - a);
            if (glm::dot(normal, towards) < 0) normal = -normal;
        }
        arrays.normal[at] = glm::vec3(glm::normalize(normal));
    }
    return image;
}

}  // namespace experiments::stability
