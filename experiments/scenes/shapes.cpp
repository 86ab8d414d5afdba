// Random numbers, circles, boxes, spheres, tubes, tori and copies.
#include "experiments/scenes/shapes.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace experiments::scenes {

using structures::geometry::TriangleMesh;

std::uint64_t Random::next() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

glm::dvec3 Random::direction() {
    const double y = uniform(-1, 1);
    const glm::dvec2 around = unit_circle(uniform()) * std::sqrt(1 - y * y);
    return {around.x, y, around.y};
}

glm::dvec2 unit_circle(double turns) {
    turns -= std::floor(turns);
    const auto quarter = std::lround(4 * turns);
    const double angle =
        2 * std::numbers::pi * (turns - 0.25 * static_cast<double>(quarter));  // within +-pi/4
    // Taylor series, to the last bit of a double within pi/4; the C library's own sine and cosine
    // differ between platforms.
    double cosine = 0, sine = 0;
    for (int k = 9; k >= 1; --k) {
        cosine = (1 + cosine) * -angle * angle / ((2 * k - 1) * (2 * k));
        sine = (1 + sine) * -angle * angle / ((2 * k) * (2 * k + 1));
    }
    const glm::dvec2 p(1 + cosine, angle * (1 + sine));
    switch (quarter % 4) {
        case 0:
            return p;
        case 1:
            return {-p.y, p.x};
        case 2:
            return -p;
        default:
            return {p.y, -p.x};
    }
}

namespace {

std::uint32_t add_vertex(TriangleMesh& mesh, glm::dvec3 position) {
    mesh.positions.emplace_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// Joins two circles of `sides` vertices that start at `near` and `far`.
void join_rings(TriangleMesh& mesh, std::uint32_t near, std::uint32_t far, std::uint32_t sides) {
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t j = (i + 1) % sides;
        mesh.triangles.emplace_back(near + i, near + j, far + j);
        mesh.triangles.emplace_back(near + i, far + j, far + i);
    }
}

}  // namespace

void add_quad(TriangleMesh& mesh, const std::array<glm::dvec3, 4>& corners) {
    const std::uint32_t first = add_vertex(mesh, corners[0]);
    for (int k = 1; k < 4; ++k) add_vertex(mesh, corners[k]);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
}

void add_box(TriangleMesh& mesh, glm::dvec3 lower, glm::dvec3 upper) {
    const auto corner = [&](int x, int y, int z) {
        return glm::dvec3(x ? upper.x : lower.x, y ? upper.y : lower.y, z ? upper.z : lower.z);
    };
    const std::uint32_t first = add_vertex(mesh, corner(0, 0, 0));
    for (int k = 1; k < 8; ++k) add_vertex(mesh, corner(k & 1, k >> 2, k >> 1 & 1));
    // Vertex bits: 1 = x, 2 = z, 4 = y.
    constexpr std::uint32_t kQuads[5][4] = {
        {4, 6, 7, 5}, {0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}};
    for (const auto& q : kQuads) {
        mesh.triangles.emplace_back(first + q[0], first + q[1], first + q[2]);
        mesh.triangles.emplace_back(first + q[0], first + q[2], first + q[3]);
    }
}

void add_sphere(TriangleMesh& mesh, glm::dvec3 center, double radius, std::size_t segments) {
    const auto around = static_cast<std::uint32_t>(segments);
    const std::uint32_t stacks = around / 2 + 1;
    std::vector<glm::dvec2> circle(around);
    for (std::uint32_t i = 0; i < around; ++i) circle[i] = unit_circle(-double(i) / around);

    const std::uint32_t bottom = add_vertex(mesh, center - glm::dvec3(0, radius, 0));
    for (std::uint32_t k = 1; k < stacks; ++k) {
        const glm::dvec2 slope = radius * unit_circle(0.5 * k / stacks);
        for (const glm::dvec2 c : circle)
            add_vertex(mesh, center + glm::dvec3(slope.y * c.x, -slope.x, slope.y * c.y));
    }
    const std::uint32_t top = add_vertex(mesh, center + glm::dvec3(0, radius, 0));
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t j = (i + 1) % around;
        mesh.triangles.emplace_back(bottom, bottom + 1 + j, bottom + 1 + i);
        mesh.triangles.emplace_back(top, top - around + i, top - around + j);
    }
    for (std::uint32_t k = 0; k + 2 < stacks; ++k)
        join_rings(mesh, bottom + 1 + k * around, bottom + 1 + (k + 1) * around, around);
}

void add_tube(TriangleMesh& mesh, std::span<const Ring> rings, std::size_t sides,
              const Relief& relief) {
    const auto around = static_cast<std::uint32_t>(sides);
    std::vector<glm::dvec2> circle(around);
    for (std::uint32_t i = 0; i < around; ++i) circle[i] = unit_circle(double(i) / around);
    // `u` starts across the smallest component of the axis and is carried along by projection.
    const glm::dvec3 axis = glm::abs(rings[0].axis);
    const int least = axis.x < axis.y ? (axis.x < axis.z ? 0 : 2) : (axis.y < axis.z ? 1 : 2);
    glm::dvec3 u(0);
    u[least] = 1;

    const bool first_tip = rings.front().radius == 0, last_tip = rings.back().radius == 0;
    const auto begin = static_cast<std::uint32_t>(mesh.positions.size());
    std::uint32_t full = 0;
    for (std::size_t r = first_tip; r < rings.size() - last_tip; ++r, ++full) {
        const Ring& ring = rings[r];
        u = glm::normalize(u - glm::dot(u, ring.axis) * ring.axis);
        const glm::dvec3 v = glm::cross(ring.axis, u);
        for (std::uint32_t i = 0; i < around; ++i) {
            const double radius = relief ? ring.radius * relief(r, i) : ring.radius;
            add_vertex(mesh, ring.center + radius * (circle[i].x * u + circle[i].y * v));
        }
    }
    for (std::uint32_t r = 0; r + 1 < full; ++r)
        join_rings(mesh, begin + r * around, begin + (r + 1) * around, around);

    const std::uint32_t last = begin + (full - 1) * around;
    if (first_tip) {
        const std::uint32_t point = add_vertex(mesh, rings.front().center);
        for (std::uint32_t i = 0; i < around; ++i)
            mesh.triangles.emplace_back(begin + (i + 1) % around, begin + i, point);
    } else {
        for (std::uint32_t i = 2; i < around; ++i)
            mesh.triangles.emplace_back(begin, begin + i, begin + i - 1);
    }
    if (last_tip) {
        const std::uint32_t point = add_vertex(mesh, rings.back().center);
        for (std::uint32_t i = 0; i < around; ++i)
            mesh.triangles.emplace_back(last + i, last + (i + 1) % around, point);
    } else {
        for (std::uint32_t i = 2; i < around; ++i)
            mesh.triangles.emplace_back(last, last + i - 1, last + i);
    }
}

void add_torus(TriangleMesh& mesh, glm::dvec3 center, double radius, double thickness,
               std::size_t segments, std::size_t sides) {
    const auto along = static_cast<std::uint32_t>(segments);
    const auto around = static_cast<std::uint32_t>(sides);
    const auto begin = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t k = 0; k < along; ++k) {
        const glm::dvec2 out = unit_circle(double(k) / along);
        for (std::uint32_t i = 0; i < around; ++i) {
            const glm::dvec2 c = thickness * unit_circle(double(i) / around);
            const double distance = radius + c.x;
            add_vertex(mesh, center + glm::dvec3(distance * out.x, c.y, -distance * out.y));
        }
    }
    for (std::uint32_t k = 0; k < along; ++k)
        join_rings(mesh, begin + (k + 1) % along * around, begin + k * around, around);
}

void add_copy(TriangleMesh& mesh, const TriangleMesh& model, glm::dvec3 at, double turns,
              double scale) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dvec2 c = scale * unit_circle(turns);
    for (const glm::dvec3 p : model.positions)
        add_vertex(mesh,
                   at + glm::dvec3(c.x * p.x + c.y * p.z, scale * p.y, c.x * p.z - c.y * p.x));
    for (const glm::uvec3 t : model.triangles) mesh.triangles.push_back(t + first);
}

void add_ground(TriangleMesh& mesh, double half_side) {
    const double e = half_side;
    add_quad(mesh, {{{-e, 0, -e}, {-e, 0, e}, {e, 0, e}, {e, 0, -e}}});
}

}  // namespace experiments::scenes
