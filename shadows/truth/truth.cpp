#include "shadows/truth/truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "shadows/truth/band.hpp"
#include "shadows/truth/exact.hpp"
#include "shadows/truth/silhouette.hpp"

namespace shadows::truth {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundings = 64 * 0x1p-24;

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::vector<std::uint32_t> find_casters(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> casters;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (finite(mesh.corner(t, 0)) && finite(mesh.corner(t, 1)) && finite(mesh.corner(t, 2)) &&
            !mesh.degenerate(t))
            casters.push_back(t);
    return casters;
}

void check_light(const Light& light) {
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3& v = light.vector;
    if (!finite(v) || (directional && v == glm::vec3(0)))
        throw std::invalid_argument(fmt::format(
            "Truth: the light's {} is ({}, {}, {}); {}", directional ? "direction" : "position",
            v.x, v.y, v.z, finite(v) ? "give it a length" : "it has to be finite"));
}

}  // namespace

Effort& Effort::operator+=(const Effort& other) {
    filtered += other.filtered;
    exact += other.exact;
    candidates += other.candidates;
    milliseconds += other.milliseconds;
    return *this;
}

struct Truth::Scene {
    const TriangleMesh& mesh;
    Light light;
    std::vector<std::uint32_t> casters;
    Silhouette silhouette;
    double diagonal = 0, coordinate = 0;  // of the casters' bounds
    /// Nearest caster of a point light, and the distance of the second nearest.
    std::uint32_t nearest = kNoReceiver;
    double nearest_distance = kInfinity, second_distance = kInfinity;

    Scene(const TriangleMesh& m, const Light& l) : mesh(m), light(l), casters(find_casters(m)) {
        silhouette = Silhouette(mesh, light, casters);
        structures::geometry::Aabb box;
        for (const std::uint32_t t : casters) box.grow(mesh.triangle_bounds(t));
        if (!box.empty()) {
            diagonal = glm::length(glm::dvec3(box.upper) - glm::dvec3(box.lower));
            coordinate = std::max(largest(box.lower), largest(box.upper));
        }
        if (light.type == Light::Type::directional) return;
        for (const std::uint32_t t : casters) {
            const double distance = triangle_distance(light.vector, mesh.corner(t, 0),
                                                      mesh.corner(t, 1), mesh.corner(t, 2));
            if (distance < nearest_distance) {
                second_distance = nearest_distance;
                nearest_distance = distance;
                nearest = t;
            } else {
                second_distance = std::min(second_distance, distance);
            }
        }
    }

    double epsilon(const glm::vec3& p) const {
        if (light.type == Light::Type::directional)
            return kRoundings * (diagonal + largest(p) + coordinate);
        return kRoundings * (glm::length(glm::dvec3(light.vector) - glm::dvec3(p)) + largest(p) +
                             largest(light.vector));
    }

    /// Edge k of triangle t turns around the segment from p to the light: sign of
    /// det(u - p, v - p, L - p).
    int turn(const glm::vec3& u, const glm::vec3& v, const glm::vec3& p, Signs& signs) const {
        return light.type == Light::Type::directional
                   ? orientation_towards(u, v, -light.vector, p, signs)
                   : orientation(u, v, light.vector, p, signs);
    }

    bool occludes(std::uint32_t t, const glm::vec3& p, Signs& signs) const {
        const int side = silhouette.side(t);
        if (side == 0) return false;
        const glm::vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        return turn(a, b, p, signs) * side >= 0 && turn(b, c, p, signs) * side >= 0 &&
               turn(c, a, p, signs) * side >= 0 && orientation(a, b, c, p, signs) == side;
    }

    bool shadowed(const glm::vec3& p, std::uint32_t own, Signs& signs) const {
        return std::any_of(casters.begin(), casters.end(),
                           [&](std::uint32_t t) { return t != own && occludes(t, p, signs); });
    }

    /// How near the answer at p may change, or anything above `limit`.
    double clearance(const glm::vec3& p, std::uint32_t own, double limit) const {
        double result = nearest == own ? second_distance : nearest_distance;
        const bool has_own = own != kNoReceiver;
        for (const std::uint32_t t : casters) {
            const glm::vec3 corners[3] = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
            if (t != own)
                result = std::min(result, triangle_distance(p, corners[0], corners[1], corners[2]));
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t edge = silhouette.edge(t, k);
                if (t == own ? silhouette.multiplicity_of_others(own, k) == 0
                             : silhouette.multiplicity(edge) == 0 ||
                                   (has_own && silhouette.has_edge(own, edge)))
                    continue;
                result = std::min(result, shadow_quad_distance(p, corners[k], corners[(k + 1) % 3],
                                                               light, limit));
            }
        }
        return result;
    }

    bool faces_away(const glm::vec3& p, const glm::vec3& normal) const {
        if (normal == glm::vec3(0)) return false;
        const glm::dvec3 towards = light.type == Light::Type::directional
                                       ? -glm::dvec3(light.vector)
                                       : glm::dvec3(light.vector) - glm::dvec3(p);
        return glm::dot(glm::dvec3(normal), towards) <= 0;
    }

    Verdict judge(const glm::vec3& p, std::uint32_t own, const glm::vec3& normal,
                  Effort& effort) const {
        if (own == kNoPrimitive) return {};
        Verdict verdict{Verdict::kGeometry};
        Signs signs;
        if (shadowed(p, own, signs)) verdict.bits |= Verdict::kShadowed;
        if (own != kNoReceiver && faces_away(p, normal)) verdict.bits |= Verdict::kFacingAway;
        const double unit = epsilon(p), distance = clearance(p, own, 16 * unit);
        if (distance <= unit) verdict.bits |= Verdict::kWithin1;
        if (distance <= 4 * unit) verdict.bits |= Verdict::kWithin4;
        if (distance <= 16 * unit) verdict.bits |= Verdict::kWithin16;
        effort += {signs.filtered, signs.exact, casters.size(), 0};
        return verdict;
    }

    void check(const PointArrays& points) const {
        const std::size_t count = points.x.size();
        if (points.y.size() != count || points.z.size() != count ||
            points.primitive.size() != count || points.normal.size() != count)
            throw std::invalid_argument("Truth: the arrays of points differ in length");
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t own = points.primitive[i];
            if (own == kNoPrimitive) continue;
            if (own != kNoReceiver && own >= mesh.triangle_count())
                throw std::invalid_argument(
                    fmt::format("Truth: point {} lies on triangle {}, the mesh has {}", i, own,
                                mesh.triangle_count()));
            if (!finite({points.x[i], points.y[i], points.z[i]}))
                throw std::invalid_argument(fmt::format(
                    "Truth: point {} is ({}, {}, {}); it has to be finite or without geometry", i,
                    points.x[i], points.y[i], points.z[i]));
        }
    }
};

Truth::Truth(const TriangleMesh& mesh, const Light& light) {
    check_light(light);
    scene_ = std::make_unique<const Scene>(mesh, light);
}

Truth::~Truth() = default;

Verdicts Truth::judge(const PointArrays& points, const JudgeOptions& options) const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    scene_->check(points);
    const std::size_t count = points.x.size();
    Verdicts verdicts;
    verdicts.points.resize(count);

    // Threads take chunks as they go; this one works too, and reports.
    constexpr std::size_t kChunk = kTilePoints;
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> stopped = false;
    const auto work_chunk = [&](Effort& effort) {
        const std::size_t first = next.fetch_add(kChunk);
        for (std::size_t i = first; i < std::min(first + kChunk, count); ++i)
            verdicts.points[i] = scene_->judge({points.x[i], points.y[i], points.z[i]},
                                               points.primitive[i], points.normal[i], effort);
        return first < count && !stopped;
    };
    const unsigned threads =
        options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    std::vector<Effort> efforts(threads);
    {
        std::vector<std::jthread> helpers;
        for (unsigned i = 1; i < threads; ++i)
            helpers.emplace_back([&, i] {
                while (work_chunk(efforts[i])) continue;
            });
        while (work_chunk(efforts[0])) {
            if (!options.progress) continue;
            const double done = double(std::min(next.load(), count)) / double(count);
            if (!options.progress(done)) stopped = true;
        }
    }
    if (stopped) throw std::runtime_error("Truth: stopped before all points were judged");
    for (const Effort& effort : efforts) verdicts.effort += effort;
    verdicts.effort.milliseconds =
        std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return verdicts;
}

bool Truth::shadowed(glm::vec3 p, std::uint32_t own) const {
    Signs signs;
    return scene_->shadowed(p, own, signs);
}

double Truth::epsilon(glm::vec3 p) const { return scene_->epsilon(p); }

bool Truth::changes_nearby(glm::vec3 p, std::uint32_t own, double radius) const {
    const bool here = shadowed(p, own);
    // Rounded offsets must not end up farther away than asked for.
    const double reach = std::max(0.0, radius - 0x1p-22 * (largest(p) + radius));
    const auto differs = [&](const glm::dvec3& direction) {
        const glm::dvec3 moved = glm::dvec3(p) + reach * glm::normalize(direction);
        return shadowed(glm::vec3(moved), own) != here;
    };
    for (int i = 0; i < 27; ++i) {
        const glm::dvec3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        const double nonzero = glm::dot(direction, direction);
        if ((nonzero == 1 || nonzero == 3) && differs(direction)) return true;
    }
    return false;
}

}  // namespace shadows::truth
