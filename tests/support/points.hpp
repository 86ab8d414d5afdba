// Images of points to ask a shadow method about.
#pragma once

#include <random>

#include "shadows/points.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

/// An image of `width` x `height` pixels without points, padded to whole tiles.
inline shadows::PointArrays no_points(std::uint32_t width, std::uint32_t height) {
    const auto tiles = [](std::uint32_t side) {
        return (side + shadows::kTileSide - 1) / shadows::kTileSide;
    };
    const std::size_t count = std::size_t{tiles(width)} * tiles(height) * shadows::kTilePoints;
    shadows::PointArrays points;
    for (std::vector<float>* plane : {&points.x, &points.y, &points.z}) plane->resize(count);
    points.primitive.assign(count, shadows::kNoPrimitive);
    points.normal.assign(count, glm::vec3(0, 0, 1));
    return points;
}

/// Puts a point at place `i` of the arrays, on triangle `primitive` or in free space.
inline void set_point(shadows::PointArrays& points, std::size_t i, glm::vec3 p,
                      std::uint32_t primitive = shadows::kNoReceiver) {
    points.x[i] = p.x;
    points.y[i] = p.y;
    points.z[i] = p.z;
    points.primitive[i] = primitive;
}

inline glm::vec3 position(const shadows::PointArrays& points, std::size_t i) {
    return {points.x[i], points.y[i], points.z[i]};
}

/// `places` in free space, one after the other, in an image of `width` x `height` pixels.
inline shadows::PointArrays free_points(const std::vector<glm::vec3>& places, std::uint32_t width,
                                        std::uint32_t height) {
    shadows::PointArrays points = no_points(width, height);
    for (std::size_t i = 0; i < places.size(); ++i) set_point(points, i, places[i]);
    return points;
}

/// Points at random places of random triangles, with every tenth point left without geometry.
inline shadows::PointArrays random_points(const structures::geometry::TriangleMesh& mesh,
                                          std::uint32_t width, std::uint32_t height,
                                          std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    shadows::PointArrays points = no_points(width, height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            if (mesh.triangles.empty() || random() % 10 == 0) continue;
            const auto id = static_cast<std::uint32_t>(random() % mesh.triangle_count());
            if (mesh.degenerate(id)) continue;
            float u = unit(random), v = unit(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const glm::vec3 a = mesh.corner(id, 0), b = mesh.corner(id, 1), c = mesh.corner(id, 2);
            const std::uint32_t i = shadows::point_index(x, y, width);
            set_point(points, i, a + u * (b - a) + v * (c - a), id);
            points.normal[i] = glm::normalize(glm::cross(b - a, c - a));
        }
    return points;
}

}  // namespace tests
