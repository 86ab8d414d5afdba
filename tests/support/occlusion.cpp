#include "tests/support/occlusion.hpp"

#include <algorithm>
#include <cmath>

namespace tests {
namespace {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

glm::vec3 axis_last(glm::vec3 v, int axis) {
    return axis == 0 ? glm::vec3(v.y, v.z, v.x) : axis == 1 ? glm::vec3(v.z, v.x, v.y) : v;
}

bool separates(glm::vec3 p, glm::vec3 target, bool directional, glm::vec3 a, glm::vec3 b,
               glm::vec3 c) {
    const glm::dvec3 corner(a);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - corner, glm::dvec3(c) - corner);
    const double here = glm::dot(normal, glm::dvec3(p) - corner);
    const double there =
        glm::dot(normal, directional ? glm::dvec3(target) : glm::dvec3(target) - corner);
    return (here < 0 && there > 0) || (here > 0 && there < 0);
}

/// det[a, b, c] and the size of its terms.
struct Volume {
    double value, size;
};
Volume volume(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return {glm::dot(glm::cross(a, b), c), glm::length(a) * glm::length(b) * glm::length(c)};
}

}  // namespace

bool occludes(glm::vec3 p, const Light& light, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3 target = directional ? -light.vector : light.vector;
    const glm::vec3 towards = directional ? target : target - p;
    const glm::vec3 size = glm::abs(towards);
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const glm::vec3 d = axis_last(towards, axis);
    const glm::vec3 shear(d.x / d.z, d.y / d.z, 1.0f / d.z);
    const glm::vec3 ra = axis_last(a - p, axis), rb = axis_last(b - p, axis),
                    rc = axis_last(c - p, axis);
    const auto sheared = [&](glm::vec3 r) {
        return glm::vec2(r.x - shear.x * r.z, r.y - shear.y * r.z);
    };
    const glm::vec2 sa = sheared(ra), sb = sheared(rb), sc = sheared(rc);
    const auto cross = [](auto s, auto t) { return s.x * t.y - s.y * t.x; };
    const float u = cross(sc, sb), v = cross(sa, sc), w = cross(sb, sa);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    if (!(std::abs(u) > 0 && std::abs(v) > 0 && std::abs(w) > 0)) {
        const glm::dvec2 da(sa), db(sb), dc(sc);
        const double du = cross(dc, db), dv = cross(da, dc), dw = cross(db, da);
        const bool below = du < 0 || dv < 0 || dw<0, above = du> 0 || dv > 0 || dw > 0;
        if (below == above) return false;
    }
    // The shader takes a shortcut where it is sure of this.
    return separates(p, target, directional, a, b, c);
}

bool occluded(glm::vec3 p, std::uint32_t own, const Light& light, const TriangleMesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (t != own && !mesh.degenerate(t) &&
            occludes(p, light, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)))
            return true;
    return false;
}

Answer occluded_double(glm::vec3 p, std::uint32_t own, const Light& light,
                       const TriangleMesh& mesh) {
    const bool directional = light.type == Light::Type::directional;
    const glm::dvec3 from(p);
    const glm::dvec3 towards =
        directional ? -glm::dvec3(light.vector) : glm::dvec3(light.vector) - from;
    Answer answer = Answer::no;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        if (t == own || mesh.degenerate(t)) continue;
        const glm::dvec3 a = glm::dvec3(mesh.corner(t, 0)) - from,
                         b = glm::dvec3(mesh.corner(t, 1)) - from,
                         c = glm::dvec3(mesh.corner(t, 2)) - from;
        const double tolerance = 64.0 / (1 << 24);
        const Volume edges[] = {volume(a, b, towards), volume(b, c, towards),
                                volume(c, a, towards)};
        bool below = false, above = false, unsure = false;
        for (const Volume& edge : edges) {
            below |= edge.value < -tolerance * edge.size;
            above |= edge.value > tolerance * edge.size;
            unsure |= std::abs(edge.value) <= tolerance * edge.size;
        }
        if (below && above) continue;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double here = -glm::dot(normal, a), along = glm::dot(normal, towards);
        const double there = directional ? along : here + along;
        const double reach = std::max({glm::length(a), glm::length(b), glm::length(c)});
        const double slack = tolerance * glm::length(b - a) * glm::length(c - a) *
                             (directional ? 1.0 : reach + glm::length(towards));
        unsure |= std::abs(here) <= tolerance * glm::length(b - a) * glm::length(c - a) * reach;
        unsure |= std::abs(there) <= slack;
        if (unsure)
            answer = Answer::unsure;
        else if ((here < 0) != (there < 0))
            return Answer::yes;
    }
    return answer;
}

}  // namespace tests
