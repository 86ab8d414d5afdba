// Building blocks of the generators: random numbers, points on a circle, boxes, spheres, tubes,
// tori and copies, reproducible to the last bit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "structures/geometry/triangle_mesh.hpp"

namespace experiments::scenes {

/// splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next();
    /// In [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// In [0, count), for counts far below 2^32.
    std::uint32_t index(std::uint32_t count) {
        return static_cast<std::uint32_t>((next() >> 32) * count >> 32);
    }
    /// Evenly spread on the unit sphere.
    glm::dvec3 direction();

  private:
    std::uint64_t state_;
};

/// (cos, sin) of an angle in turns, exact at multiples of a quarter.
glm::dvec2 unit_circle(double turns);

/// A quad as two triangles, counter-clockwise from outside.
void add_quad(structures::geometry::TriangleMesh& mesh, const std::array<glm::dvec3, 4>& corners);

/// The sides and the top of a box: 10 triangles.
void add_box(structures::geometry::TriangleMesh& mesh, glm::dvec3 lower, glm::dvec3 upper);

/// A closed sphere of segments^2 triangles: `segments` (even, from 4) around, segments / 2 + 1 from
/// pole to pole.
void add_sphere(structures::geometry::TriangleMesh& mesh, glm::dvec3 center, double radius,
                std::size_t segments);

struct Ring {
    glm::dvec3 center;
    glm::dvec3 axis;  ///< unit length, along the tube
    double radius;
};

/// Factor of a tube's radius at a side of a ring.
using Relief = std::function<double(std::size_t ring, std::size_t side)>;

/// A closed tube of `sides` sides through two rings or more, its ends capped flat: 2 * sides
/// triangles per stretch and sides - 2 per cap. A first or last ring of radius 0 is a tip: `sides`
/// triangles in place of the stretch and the cap; between two tips there is a ring at least. The
/// rings do not twist against each other. Without `relief` they are round.
void add_tube(structures::geometry::TriangleMesh& mesh, std::span<const Ring> rings,
              std::size_t sides, const Relief& relief = {});

/// A torus around the vertical through `center`: a circle of this radius, `thickness` the radius of
/// what runs along it; 2 * segments * sides triangles.
void add_torus(structures::geometry::TriangleMesh& mesh, glm::dvec3 center, double radius,
               double thickness, std::size_t segments, std::size_t sides);

/// A copy of `model`: scaled, turned about the vertical axis, then moved from the origin to `at`.
void add_copy(structures::geometry::TriangleMesh& mesh,
              const structures::geometry::TriangleMesh& model, glm::dvec3 at, double turns,
              double scale = 1);

/// A horizontal square of two triangles at height 0, facing up.
void add_ground(structures::geometry::TriangleMesh& mesh, double half_side);

}  // namespace experiments::scenes
