// Scenes on which every exact shadow method answers bit for bit like brute force: what is hard
// about geometry, about floating point and about sizes, and ordinary triangles in between.
//
//     for (const SceneGroup& group : scene_groups())
//         for (const ExactScene& scene : group.make())
//             compare(answer(scene), brute_force(scene));
#pragma once

#include <span>
#include <string>
#include <vector>

#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

struct ExactScene {
    std::string name;
    TriangleMesh mesh;
    Light light;
    shadows::PointArrays points;
    std::uint32_t width = 16, height = 16;
    /// Triangles that brute force looks at, from the first on: the others repeat them. No point
    /// lies on a triangle that is repeated.
    std::size_t distinct = ~std::size_t{0};
};

/// Per point, whether it is lit: every triangle tried in turn by the exact test.
std::vector<bool> brute_force(const ExactScene& scene);
/// Points whose bit in `visible` is not the one expected.
std::size_t differences(const shadows::Visibility& visible, const std::vector<bool>& expected);

/// Seed of what differs from run to run; printed when first asked for.
std::uint32_t new_seed();

struct SoupShape {
    std::uint32_t triangles = 100;
    float size = 0.3f;  ///< of a triangle, in a cube of side 1
    std::uint32_t width = 48, height = 32;
    float scale = 1;  ///< of everything, before it is moved
    glm::vec3 offset{0};
};
/// Random triangles, a point light among them, and points on triangles, anywhere, and, so that
/// beams are of use, neighbours on a plane.
ExactScene soup(std::uint32_t seed, const SoupShape& shape);
/// 200 triangles, and 300 long thin ones in all directions.
ExactScene thin_soup(std::uint32_t seed);
ExactScene directional(ExactScene scene, glm::vec3 direction);

/// Points behind a closed fan of triangles around its hub, exactly on the lines from the light
/// through its vertices and along its edges, and their neighbours in floating point. All but the
/// last 512 places of the image are within the rim.
ExactScene fan(const Light& light);
/// A box with the light in its middle, points within, on, and outside its walls.
ExactScene room();
/// Points on triangles of one plane, each on one of them.
ExactScene coplanar();
/// Cables of thin triangles, points behind them.
ExactScene cables();

// What double precision cannot tell:
/// The light and all points in the plane of all triangles, which is parallel to no axis.
ExactScene in_one_plane(int triangles);
/// Segments through the middle of an edge, which belongs to the triangle.
ExactScene behind_middles_of_edges();

struct SceneGroup {
    const char* name;
    std::vector<ExactScene> (*make)();
    bool quick;  ///< also for configurations that are not a method's default
};
std::span<const SceneGroup> scene_groups();

}  // namespace tests
