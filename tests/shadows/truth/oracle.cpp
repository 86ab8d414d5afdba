#include "tests/shadows/truth/oracle.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <map>

namespace tests {
namespace {

using boost::multiprecision::cpp_rational;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using Rational = std::array<cpp_rational, 3>;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

Rational rational(glm::vec3 v) { return {cpp_rational(v.x), cpp_rational(v.y), cpp_rational(v.z)}; }
Rational minus(const Rational& a, const Rational& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
int determinant(const Rational& a, const Rational& b, const Rational& c) {
    cpp_rational sum = 0;
    for (int i = 0; i < 3; ++i)
        sum += a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]);
    return sum.sign();
}

bool directional(const Light& light) { return light.type == Light::Type::directional; }

/// Sign of N . (a - L), or N . vector: that of rational_orientation(a, b, c, p) for p on its side.
int light_side(const Light& light, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    return directional(light) ? rational_orientation_towards(b, c, light.vector, a)
                              : rational_orientation(a, b, c, light.vector);
}

Real distance_to_segment(Vector p, Vector a, Vector b) {
    const Vector along = b - a;
    const Real size = glm::dot(along, along);
    const Real t = size > 0 ? std::clamp(glm::dot(p - a, along) / size, Real(0), Real(1)) : Real(0);
    return glm::length(a + t * along - p);
}

}  // namespace

int rational_orientation(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o) {
    const Rational origin = rational(o);
    return determinant(minus(rational(a), origin), minus(rational(b), origin),
                       minus(rational(c), origin));
}

int rational_orientation_towards(glm::vec3 a, glm::vec3 b, glm::vec3 direction, glm::vec3 o) {
    const Rational origin = rational(o);
    return determinant(minus(rational(a), origin), minus(rational(b), origin), rational(direction));
}

bool shadowed_by_any(glm::vec3 p, std::uint32_t own, const Light& light, const TriangleMesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        if (t == own || mesh.degenerate(t)) continue;
        const glm::vec3 v[3] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
        const int here = rational_orientation(v[0], v[1], v[2], p);
        if (here * light_side(light, v[0], v[1], v[2]) >= 0) continue;
        bool below = false, above = false;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 &from = v[k], &to = v[(k + 1) % 3];
            const int turn = directional(light)
                                 ? rational_orientation_towards(from, to, light.vector, p)
                                 : rational_orientation(from, to, light.vector, p);
            below |= turn < 0;
            above |= turn > 0;
        }
        if (!(below && above)) return true;
    }
    return false;
}

// By barycentric coordinates of the projection.
Real distance_to_triangle(Vector p, Vector a, Vector b, Vector c) {
    const Vector ab = b - a, ac = c - a, normal = glm::cross(ab, ac);
    const Real boundary = std::min(
        {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
    const Real size = glm::dot(normal, normal);
    if (!(size > 0)) return boundary;
    const Vector ap = p - a;
    const Real v = glm::dot(glm::cross(ap, ac), normal) / size;
    const Real w = glm::dot(glm::cross(ab, ap), normal) / size;
    if (v < 0 || w < 0 || v + w > 1) return boundary;
    return std::abs(glm::dot(ap, normal)) / std::sqrt(size);
}

Real distance_to_quad(glm::vec3 p, glm::vec3 a, glm::vec3 b, const Light& light) {
    const Vector from(p), u(a), v(b);
    // Cut off where it is surely farther away than its edge: at twice the distance.
    const Real reach = glm::length(u - from) + glm::length(v - from);
    const Vector source(light.vector);
    Vector u_end, v_end;
    if (directional(light)) {
        const Vector step = Real(2) * reach / glm::length(source) * source;
        u_end = u + step;
        v_end = v + step;
    } else {
        // Everything beyond a distance r + |p - L| of the light is farther than r from p; the chord
        // between the ends is nearer to the light than they are, by the edge's own flatness.
        const Real far = reach + glm::length(from - source);
        const Real nearest = distance_to_segment(source, u, v);
        if (!(nearest > 0)) return 0;
        const Real factor = 1 + 2 * far / nearest;
        u_end = source + factor * (u - source);
        v_end = source + factor * (v - source);
    }
    return std::min(distance_to_triangle(from, u, v, v_end),
                    distance_to_triangle(from, u, v_end, u_end));
}

Real clearance(glm::vec3 p, std::uint32_t own, const Light& light, const TriangleMesh& mesh) {
    using Corner = std::array<float, 3>;
    const auto key = [](glm::vec3 v) { return Corner{v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; };
    std::map<std::pair<Corner, Corner>, int> multiplicity;
    Real result = kInfinity;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        if (t == own || mesh.degenerate(t)) continue;
        const glm::vec3 v[3] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
        const int side = light_side(light, v[0], v[1], v[2]);
        for (int k = 0; k < 3; ++k) {
            const Corner from = key(v[k]), to = key(v[(k + 1) % 3]);
            multiplicity[{std::min(from, to), std::max(from, to)}] += from < to ? side : -side;
        }
        const Vector a(v[0]), b(v[1]), c(v[2]);
        result = std::min(result, distance_to_triangle(Vector(p), a, b, c));
        if (!directional(light))
            result = std::min(result, distance_to_triangle(Vector(light.vector), a, b, c));
    }
    for (const auto& [edge, count] : multiplicity) {
        const auto& [u, v] = edge;
        if (count != 0)
            result = std::min(result,
                              distance_to_quad(p, {u[0], u[1], u[2]}, {v[0], v[1], v[2]}, light));
    }
    return result;
}

}  // namespace tests
