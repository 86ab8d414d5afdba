// A ball with many thin, curved, tapering strands: long slanted triangles in overlapping boxes, the
// hardest common case for a bounding-volume hierarchy.
#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/scenes/generator_rows.hpp"
#include "experiments/scenes/shapes.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("strands are added until there"),
        {"segments", std::int64_t{16}, "stretches along a strand", {}, 2, 128},
        {"sides", std::int64_t{3}, "sides of a strand", {}, 3, 16},
        {"curl", 0.5, "how much strands wind, 0 (straight) to 1", {}, 0, 1},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

/// From inside the unit ball outwards, turning by a random walk of the direction and pulled down.
std::vector<Ring> strand(Random& random, std::size_t segments, double radius, double curl) {
    glm::dvec3 direction = random.direction(), drift(0);
    glm::dvec3 at = 0.98 * direction;
    const double length = random.uniform(0.6, 1.0), count = static_cast<double>(segments);
    std::vector<Ring> rings;
    for (std::size_t i = 0; i <= segments; ++i) {
        rings.push_back({at, direction, radius * (1 - static_cast<double>(i) / count)});
        drift = 0.7 * drift + random.direction();
        const glm::dvec3 turn = 8 * curl * drift - glm::dvec3(0, 2 * curl, 0);
        direction = glm::normalize(direction + turn * (length / count));
        at += direction * (length / count);
    }
    rings.back().radius = 0;
    return rings;
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto segments = static_cast<std::size_t>(settings.integer("segments"));
    const auto sides = static_cast<std::size_t>(settings.integer("sides"));
    const double curl = settings.real("curl");
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    GeneratedScene scene;
    const std::size_t per_strand = sides * (2 * segments - 1) + sides - 2;
    scene.mesh.triangles.reserve(triangles + per_strand);
    constexpr std::size_t kBallSegments = 24;
    add_sphere(scene.mesh, glm::dvec3(0), 1, kBallSegments);
    // The more strands, the thinner, so that the ball stays about equally full.
    const double strands = static_cast<double>(triangles) / static_cast<double>(per_strand);
    const double radius = std::clamp(0.3 / std::sqrt(strands), 0.0005, 0.02);
    while (scene.mesh.triangle_count() < triangles)
        add_tube(scene.mesh, strand(random, segments, radius, curl), sides);

    scene.camera = {{1.4f, 1.0f, 3.6f}, {0, -0.1f, 0}, {0, 1, 0}, 50};
    scene.light = {structures::geometry::Light::Type::point, {-3, 4, 3}};
    return scene;
}

}  // namespace

GeneratorRow hairball() {
    return {"hairball", "a ball with many thin, curved strands", &parameters, &generate};
}

}  // namespace experiments::scenes
