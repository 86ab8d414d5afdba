// The verdict on one point: exact answer and band from one walk along its segment to the light.
#include "shadows/truth/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shadows/truth/band.hpp"

namespace shadows::truth {

using structures::geometry::Aabb;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;

namespace {

constexpr double kRoundings = 64 * 0x1p-24;
/// The widest band that is told apart, in epsilons.
constexpr double kWidest = 16;

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::vector<std::uint32_t> find_casters(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> casters;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (!mesh.degenerate(t)) casters.push_back(t);
    return casters;
}

/// `light` if it can be judged by; throws std::invalid_argument if not.
const Light& checked(const Light& light) {
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3& v = light.vector;
    if (!finite(v) || (directional && v == glm::vec3(0)))
        throw std::invalid_argument(
            fmt::format("Truth: the light's {} is ({}, {}, {}); it has to "
                        "be finite{}",
                        directional ? "direction" : "position", v.x, v.y, v.z,
                        directional ? " and not 0" : ""));
    return light;
}

/// Whether p lies in the box of the triangle, grown by `radius`; false only if it surely does not.
bool near_box(const glm::vec3 (&corner)[3], const glm::vec3& p, double radius) {
    const double grown = radius * (1 + 0x1p-20);
    for (int axis = 0; axis < 3; ++axis) {
        const auto [lower, upper] =
            std::minmax({corner[0][axis], corner[1][axis], corner[2][axis]});
        if (double(lower) - p[axis] > grown || double(p[axis]) - upper > grown) return false;
    }
    return true;
}

}  // namespace

Truth::Scene::Scene(const TriangleMesh& mesh, const Light& light)
    : Scene(mesh, checked(light), find_casters(mesh)) {}

Truth::Scene::Scene(const TriangleMesh& mesh, const Light& light,
                    const std::vector<std::uint32_t>& casters)
    : mesh_(mesh),
      light_(light),
      directional_(light.type == Light::Type::directional),
      silhouette_(mesh, light, casters),
      candidates_(mesh, casters) {
    Aabb box;
    for (const std::uint32_t id : candidates_.order()) {
        box.grow(mesh.triangle_bounds(id));
        Caster caster{{mesh.corner(id, 0), mesh.corner(id, 1), mesh.corner(id, 2)},
                      id,
                      static_cast<std::int8_t>(silhouette_.side(id)),
                      0};
        for (int k = 0; k < 3; ++k)
            if (silhouette_.multiplicity(silhouette_.edge(id, k)) != 0) caster.outline |= 1 << k;
        casters_.push_back(caster);
    }
    if (!box.empty()) {
        diagonal_ = glm::length(glm::dvec3(box.upper) - glm::dvec3(box.lower));
        coordinate_ = std::max(largest(box.lower), largest(box.upper));
    }
    if (!directional_) find_nearest_to_light();
}

void Truth::Scene::find_nearest_to_light() {
    for (const Caster& caster : casters_) {
        const double distance =
            triangle_distance(light_.vector, caster.corner[0], caster.corner[1], caster.corner[2]);
        if (distance < nearest_distance_) {
            second_distance_ = nearest_distance_;
            nearest_distance_ = distance;
            nearest_ = caster.id;
        } else {
            second_distance_ = std::min(second_distance_, distance);
        }
    }
}

void Truth::Scene::check(const glm::vec3& p, std::uint32_t own, std::size_t index) const {
    if (own != kNoReceiver && own >= mesh_.triangle_count())
        throw std::invalid_argument(
            fmt::format("Truth: point {} lies on triangle {}, but the mesh "
                        "has {}",
                        index, own, mesh_.triangle_count()));
    if (!finite(p))
        throw std::invalid_argument(
            fmt::format("Truth: point {} is ({}, {}, {}); it has to be "
                        "finite or without geometry",
                        index, p.x, p.y, p.z));
}

double Truth::Scene::epsilon(const glm::vec3& p) const {
    if (directional_) return kRoundings * (diagonal_ + largest(p) + coordinate_);
    return kRoundings * (glm::length(glm::dvec3(light_.vector) - glm::dvec3(p)) + largest(p) +
                         largest(light_.vector));
}

Path Truth::Scene::path(const glm::vec3& p, double radius) const {
    const glm::dvec3 from(p), light(light_.vector);
    return directional_ ? Path(from, -light, std::numeric_limits<double>::infinity(), radius)
                        : Path(from, light - from, 1, radius);
}

// With m the side of the triangle on which the light lies, the segment crosses the plane if p lies
// on the other side, det(a - p, b - p, c - p) = N . (a - p) having the sign of m. The three edges'
// determinants det(a - p, b - p, L - p), ... add up to N . (L - p), of the same sign: if all are
// >= 0 or all <= 0, they are of that sign or 0.
bool Truth::Scene::occludes(const Caster& caster, const glm::vec3& p, Signs& signs) const {
    if (caster.side == 0) return false;
    const glm::vec3 &a = caster.corner[0], &b = caster.corner[1], &c = caster.corner[2];
    const auto passes = [&](const glm::vec3& u, const glm::vec3& v) {
        const int sign = directional_ ? orientation_towards(u, v, -light_.vector, p, signs)
                                      : orientation(u, v, light_.vector, p, signs);
        return sign * caster.side >= 0;
    };
    return passes(a, b) && passes(b, c) && passes(c, a) &&
           orientation(a, b, c, p, signs) == caster.side;
}

bool Truth::Scene::shadowed(const glm::vec3& p, std::uint32_t own) const {
    // The radius only has to be positive and no less than a path asks for.
    const double radius = epsilon(p);
    bool found = false;
    Signs signs;
    candidates_.visit(path(p, radius), [&](std::uint32_t slot) {
        const Caster& caster = casters_[slot];
        found = caster.id != own && occludes(caster, p, signs);
        return !found;
    });
    return found;
}

bool Truth::Scene::faces_away(const glm::vec3& p, const glm::vec3& normal) const {
    if (normal == glm::vec3(0)) return false;
    const glm::dvec3 light(light_.vector);
    return glm::dot(glm::dvec3(normal), directional_ ? -light : light - glm::dvec3(p)) <= 0;
}

/// Distance of p from the shadow quads behind those edges of its own triangle that bound the
/// shadow of others.
double Truth::Scene::own_outline_distance(const glm::vec3& p, std::uint32_t own,
                                          double limit) const {
    double distance = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
        if (silhouette_.multiplicity_of_others(own, k) != 0)
            distance = std::min(
                distance, shadow_quad_distance(p, mesh_.corner(own, k),
                                               mesh_.corner(own, (k + 1) % 3), light_, limit));
    return distance;
}

// One walk finds everything: occluders, triangles near p, and edges whose shadow quads are near p.
// For if a point X + s (X - L), s >= 0, of the quad behind X lies within r of p, then, shrunk about
// the light by 1 + s, X lies within r of a point of the segment from p to L; for a directional
// light the same holds after moving both against its direction.
Verdict Truth::Scene::judge(const glm::vec3& p, std::uint32_t own, const glm::vec3& normal,
                            Effort& effort) const {
    const bool has_own = own != kNoReceiver;
    const double unit = epsilon(p), limit = kWidest * unit;
    bool found = false;
    Signs signs;
    double distance = nearest_ == own ? second_distance_ : nearest_distance_;
    if (has_own) distance = std::min(distance, own_outline_distance(p, own, limit));

    candidates_.visit(path(p, limit), [&](std::uint32_t slot) {
        ++effort.candidates;
        const Caster& caster = casters_[slot];
        if (caster.id == own) return true;
        found = found || occludes(caster, p, signs);
        for (int k = 0; k < 3; ++k) {
            if (!(caster.outline >> k & 1)) continue;
            const double quad = shadow_quad_distance(p, caster.corner[k],
                                                     caster.corner[(k + 1) % 3], light_, limit);
            const bool owned = has_own && quad <= limit &&
                               silhouette_.has_edge(own, silhouette_.edge(caster.id, k));
            if (!owned) distance = std::min(distance, quad);
        }
        if (near_box(caster.corner, p, limit))
            distance = std::min(distance, triangle_distance(p, caster.corner[0], caster.corner[1],
                                                            caster.corner[2]));
        return !(found && distance <= unit);
    });

    Verdict verdict{Verdict::kGeometry};
    if (found) verdict.bits |= Verdict::kShadowed;
    if (has_own && faces_away(p, normal)) verdict.bits |= Verdict::kFacingAway;
    if (distance <= unit) verdict.bits |= Verdict::kWithin1;
    if (distance <= 4 * unit) verdict.bits |= Verdict::kWithin4;
    if (distance <= kWidest * unit) verdict.bits |= Verdict::kWithin16;
    effort.filtered += signs.filtered;
    effort.exact += signs.exact;
    return verdict;
}

}  // namespace shadows::truth
