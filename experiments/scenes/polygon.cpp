// Polygons into triangles.
#include <array>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using Corners = std::vector<std::uint32_t>;

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// The corners flattened along the polygon's own normal (Newell: the sum over the edges, right for
/// any simple polygon), turned so that it runs counter-clockwise.
std::vector<glm::dvec2> flatten(std::span<const std::uint32_t> corners,
                                const std::vector<glm::vec3>& positions) {
    const glm::dvec3 origin = positions[corners[0]];
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(glm::dvec3(positions[corners[i]]) - origin,
                             glm::dvec3(positions[corners[(i + 1) % corners.size()]]) - origin);
    const glm::dvec3 size = glm::abs(normal);
    const int drop = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    std::vector<glm::dvec2> flat;
    for (const std::uint32_t corner : corners) {
        const glm::dvec3 p = glm::dvec3(positions[corner]) - origin;
        flat.push_back(normal[drop] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
    }
    return flat;
}

bool inside(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
}

/// Cuts off corners whose triangle holds no other corner. A polygon that crosses itself may run out
/// of such corners; the next one is then cut off anyway, so that n - 2 triangles always come out.
void clip_ears(Corners corners, std::vector<glm::dvec2> flat, std::vector<glm::uvec3>& triangles) {
    std::size_t at = 0, passed = 0;
    while (corners.size() > 3) {
        const std::size_t n = corners.size();
        const std::size_t before = (at + n - 1) % n, after = (at + 1) % n;
        const glm::dvec2 a = flat[before], b = flat[at], c = flat[after];
        bool ear = cross(b - a, c - b) > 0;
        for (std::size_t i = 0; ear && i < n; ++i) {
            const glm::dvec2 p = flat[i];
            if (i != before && i != at && i != after && p != a && p != b && p != c)
                ear = !inside(p, a, b, c);
        }
        if (!ear && ++passed < n) {
            at = after;
            continue;
        }
        triangles.emplace_back(corners[before], corners[at], corners[after]);
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(at));
        flat.erase(flat.begin() + static_cast<std::ptrdiff_t>(at));
        at %= corners.size();
        passed = 0;
    }
    triangles.emplace_back(corners[0], corners[1], corners[2]);
}

bool convex(const std::vector<glm::dvec2>& flat) {
    const std::size_t n = flat.size();
    for (std::size_t i = 0; i < n; ++i)
        if (cross(flat[(i + 1) % n] - flat[i], flat[(i + 2) % n] - flat[(i + 1) % n]) < 0)
            return false;
    return true;
}

}  // namespace

void add_polygon(std::span<const std::uint32_t> corners, LoadedMesh& scene) {
    auto& triangles = scene.mesh.triangles;
    if (corners.size() < 3) {
        ++scene.report.skipped;
        return;
    }
    if (corners.size() == 3) {
        triangles.emplace_back(corners[0], corners[1], corners[2]);
        return;
    }
    ++scene.report.polygons;
    // The largest polygon that clipping ears, a quadratic search, is worth.
    constexpr std::size_t kMaxClipped = 1 << 12;
    std::vector<glm::dvec2> flat = flatten(corners, scene.mesh.positions);
    if (corners.size() <= kMaxClipped && !convex(flat)) {
        clip_ears({corners.begin(), corners.end()}, std::move(flat), triangles);
        return;
    }
    for (std::size_t i = 2; i < corners.size(); ++i)
        triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
}

}  // namespace experiments::scenes
