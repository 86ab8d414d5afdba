// A scene of the stress suite: triangles, a light, and points whose answer is known beforehand or
// left to the judge.
//
//     Scene scene = make_scene("lit from above", point_light({0, 0, 0}));
//     add_quad(scene.mesh, corners);
//     ask(scene, behind(scene.light, {0, -3, 0}, 2), Expected::shadowed);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/scenes/shapes.hpp"
#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace experiments::stability {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

/// What geometry says of a point; `unsaid` where only the judge knows.
enum class Expected : std::uint8_t { unsaid, lit, shadowed };

/// For a shadow that reaches between `certain` and `outside`: what `reach` away from its middle is
/// to be expected.
constexpr Expected by_reach(double reach, double certain, double outside) {
    return reach < certain   ? Expected::shadowed
           : reach > outside ? Expected::lit
                             : Expected::unsaid;
}

struct ScenePoint {
    glm::vec3 position;
    std::uint32_t receiver = shadows::kNoReceiver;  ///< the triangle it lies on
    Expected expected = Expected::unsaid;
};

struct Scene {
    std::string name;  ///< tells the scenes of one test apart; may be empty
    TriangleMesh mesh{};
    Light light{};
    std::vector<ScenePoint> points{};
    /// Not 0: only the first `essential` triangles matter, and the rest must not change the image.
    std::size_t essential = 0;
    /// Whether the coordinates are those that were chosen; else they were rounded since.
    bool as_built = true;
    /// Answers must be as expected within the rounding band too, as built.
    bool exact = false;
};

inline constexpr glm::vec3 kOrigin(0), kDown(0, -1, 0);

Light point_light(glm::vec3 position);
/// `direction` is the way the light travels.
Light directional_light(glm::vec3 direction);
/// The point light if `type` says so, else the directional one.
Light either_light(Light::Type type, glm::vec3 position, glm::vec3 direction);

Scene make_scene(std::string name, const Light& light);

/// Where the shadow of `q` falls: `times` as far from a point light as q; for a directional light
/// as if that were 4 units from q.
glm::dvec3 behind(const Light& light, glm::dvec3 q, double times);
/// Where the shadow of `q` falls on the plane of that height.
glm::dvec3 on_height(const Light& light, glm::dvec3 q, double y);

void ask(Scene& scene, glm::dvec3 position, Expected expected,
         std::uint32_t receiver = shadows::kNoReceiver);

void add_triangle(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
/// A horizontal square of two triangles; its diagonal runs from (-,-) to (+,+) in x and z. Returns
/// the id of the first, which holds the corner (-,+).
std::uint32_t add_floor(TriangleMesh& mesh, glm::dvec3 center, double half_side);
/// Of the two triangles of add_floor, the one below (x, z), given relative to its centre.
std::uint32_t floor_at(std::uint32_t first, double x, double z);
/// All twelve triangles of a box.
void add_closed_box(TriangleMesh& mesh, glm::dvec3 lower, glm::dvec3 upper);
/// A closed tube from a to b, the cable of the renderers of cables.
void add_cable(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, double radius, std::size_t sides);
/// The same with hemispheres for ends.
void add_capsule(TriangleMesh& mesh, glm::dvec3 a, glm::dvec3 b, double radius, std::size_t sides);

/// The points as an image 16 pixels wide, row after row, padded to whole tiles.
struct Image {
    shadows::PointArrays arrays;
    std::uint32_t width = shadows::kTileSide, height = 0;
};
Image make_image(const Scene& scene);
/// Place of `scene.points[i]` in the arrays of its image.
constexpr std::uint32_t place_in_image(std::size_t i) {
    return shadows::point_index(std::uint32_t(i) % shadows::kTileSide,
                                std::uint32_t(i) / shadows::kTileSide, shadows::kTileSide);
}

}  // namespace experiments::stability
