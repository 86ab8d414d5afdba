#include "tests/support/occlusion.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>

namespace tests {
namespace {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

glm::vec3 axis_last(glm::vec3 v, int axis) {
    return axis == 0 ? glm::vec3(v.y, v.z, v.x) : axis == 1 ? glm::vec3(v.z, v.x, v.y) : v;
}

using Exact = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<1024, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

/// Sign of det[q - w x, y - x, z - x].
int side(glm::vec3 q, int w, glm::vec3 x, glm::vec3 y, glm::vec3 z) {
    // Most are clear: a double-precision determinant is off by less than 16 * 2^-53 of its terms.
    const glm::dvec3 origin(x), ed = glm::dvec3(y) - origin, fd = glm::dvec3(z) - origin,
                                gd = glm::dvec3(q) - double(w) * origin;
    const glm::dvec3 left(ed.y * fd.z, ed.z * fd.x, ed.x * fd.y),
        right(ed.z * fd.y, ed.x * fd.z, ed.y * fd.x);
    const double quick = glm::dot(gd, left - right);
    const double size = glm::dot(glm::abs(gd), glm::abs(left) + glm::abs(right));
    if (std::abs(quick) > size * 0x1p-49) return quick > 0 ? 1 : -1;

    Exact e[3], f[3], g[3];
    for (int i = 0; i < 3; ++i) {
        e[i] = Exact(y[i]) - Exact(x[i]);
        f[i] = Exact(z[i]) - Exact(x[i]);
        g[i] = w ? Exact(q[i]) - Exact(x[i]) : Exact(q[i]);
    }
    const Exact value = g[0] * (e[1] * f[2] - e[2] * f[1]) + g[1] * (e[2] * f[0] - e[0] * f[2]) +
                        g[2] * (e[0] * f[1] - e[1] * f[0]);
    return value.sign();
}

/// det[a, b, c] and the size of its terms.
struct Volume {
    double value, size;
};
Volume volume(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    return {glm::dot(glm::cross(a, b), c), glm::length(a) * glm::length(b) * glm::length(c)};
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
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3 target = directional ? -light.vector : light.vector;
    const int w = directional ? 0 : 1;
    const int ab = side(target, w, p, b, a), bc = side(target, w, p, c, b),
              ca = side(target, w, p, a, c);
    if ((ab < 0 || bc < 0 || ca < 0) && (ab > 0 || bc > 0 || ca > 0)) return false;
    return side(p, 1, a, b, c) * side(target, w, a, b, c) < 0;
}

bool occludes(glm::vec3 p, const Light& light, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const Decision decision = occludes_filtered(p, light, a, b, c);
    if (decision != Decision::unsure) return decision == Decision::yes;
    return occludes_exactly(p, light, a, b, c);
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
