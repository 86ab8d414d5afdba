#include "tests/support/occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shadows/truth/exact.hpp"

namespace tests {
namespace {

using shadows::truth::orientation;
using shadows::truth::orientation_towards;
using shadows::truth::Signs;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;

glm::vec3 axis_last(glm::vec3 v, int axis) {
    return axis == 0 ? glm::vec3(v.y, v.z, v.x) : axis == 1 ? glm::vec3(v.z, v.x, v.y) : v;
}

}  // namespace

Decision occludes_filtered(glm::vec3 p, const Light& light, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3 towards = directional ? -light.vector : light.vector - p;
    const glm::vec3 extent = glm::abs(towards);
    const int axis =
        extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const glm::vec3 d = axis_last(towards, axis);
    const bool divides = std::abs(d.z) > 0x1p-100f && std::abs(d.z) < 0x1p100f;
    const glm::vec3 shear = divides ? glm::vec3(d.x / d.z, d.y / d.z, 1.0f / d.z) : glm::vec3(0);
    const float slack = divides ? 0x1p-100f : std::numeric_limits<float>::infinity();

    const glm::vec3 ra = axis_last(a - p, axis), rb = axis_last(b - p, axis),
                    rc = axis_last(c - p, axis);
    const auto sheared = [&](glm::vec3 r) {
        return glm::vec2(r.x - shear.x * r.z, r.y - shear.y * r.z);
    };
    const glm::vec2 sa = sheared(ra), sb = sheared(rb), sc = sheared(rc);
    const auto cross = [](glm::vec2 s, glm::vec2 t) { return s.x * t.y - s.y * t.x; };
    const float u = cross(sc, sb), v = cross(sa, sc), w = cross(sb, sa);
    const glm::vec2 reach = glm::max(glm::max(glm::abs(sa), glm::abs(sb)), glm::abs(sc));
    const float across = reach.x + reach.y;
    const float deepest =
        std::max(std::max(std::abs(ra.z), std::abs(rb.z)), std::abs(rc.z)) + slack;
    const float size = across + deepest;
    const float error = (across + size * 0x1p-20f) * size * 0x1p-19f + slack;
    const float least = std::min(std::min(u, v), w), most = std::max(std::max(u, v), w);
    if (least < -error && most > error) return Decision::no;
    if (least > error || most < -error) {
        const float depth = u * (ra.z * shear.z) + v * (rb.z * shear.z) + w * (rc.z * shear.z);
        const float total = std::abs(u + v + w), scaled = least > 0 ? depth : -depth;
        const float beyond = total - scaled;
        const float near_error = 4.0f * error * (deepest * std::abs(shear.z)) + slack;
        const float far_error = near_error + 4.0f * error;
        if (far_error < 1e32f) {
            if (scaled > near_error && (directional || beyond > far_error)) return Decision::yes;
            if (scaled < -near_error || (!directional && beyond < -far_error)) return Decision::no;
        }
    }
    return Decision::unsure;
}

bool occludes_exactly(glm::vec3 p, const Light& light, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    Signs signs;
    const bool directional = light.type == Light::Type::directional;
    // On which side of the plane through p, u and v the segment runs.
    const auto turn = [&](glm::vec3 u, glm::vec3 v) {
        return directional ? orientation_towards(u, v, -light.vector, p, signs)
                           : orientation(u, v, light.vector, p, signs);
    };
    const int ab = turn(a, b), bc = turn(b, c), ca = turn(c, a);
    if ((ab < 0 || bc < 0 || ca < 0) && (ab > 0 || bc > 0 || ca > 0)) return false;
    const int light_side = directional ? orientation_towards(b, c, light.vector, a, signs)
                                       : orientation(a, b, c, light.vector, signs);
    return orientation(a, b, c, p, signs) * light_side < 0;
}

bool occluded(glm::vec3 p, std::uint32_t own, const Light& light, const TriangleMesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (t != own && !mesh.degenerate(t) &&
            occludes_exactly(p, light, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)))
            return true;
    return false;
}

}  // namespace tests
