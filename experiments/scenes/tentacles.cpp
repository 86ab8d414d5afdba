// Bundles of long, thin tentacles that grow from a floor and wave: slender curved casters close to
// each other, whose bounding volumes overlap.
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
        triangles_parameter("tentacles are added until there"),
        {"bundle", std::int64_t{12}, "tentacles in a bundle", {}, 1, 1000},
        {"segments", std::int64_t{64}, "stretches along a tentacle", {}, 4, 256},
        {"sides", std::int64_t{8}, "sides of a tentacle", {}, 3, 32},
        {"wave", 0.5, "how far they sway, 0 (straight) to 1", {}, 0, 1},
        {"phase", 0.0, "moment of the waving, in periods"},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

/// Leans outward from its bundle; a wave of growing swing runs up it.
std::vector<Ring> tentacle(Random& random, glm::dvec2 root, glm::dvec2 lean, double radius,
                           std::size_t segments, double wave, double phase) {
    const double height = random.uniform(1.6, 3);
    const double start = random.uniform(), pitch = random.uniform(0.9, 1.7);
    const glm::dvec2 across = unit_circle(random.uniform());
    const double swing = 0.8 * wave * random.uniform(0.6, 1.4);
    // Not straight up and down but on an ellipse: the second direction sways less.
    const glm::dvec2 along(-0.4 * across.y, 0.4 * across.x);
    const auto at = [&](double t) {
        const glm::dvec2 turn = unit_circle(start + pitch * t - phase);
        const glm::dvec2 ground =
            root + t * (1 + t) * 0.4 * lean + t * swing * (turn.x * across + turn.y * along);
        return glm::dvec3(ground.x, height * t - 0.02, ground.y);
    };
    std::vector<Ring> rings(segments + 1);
    const double step = 1 / double(segments);
    for (std::size_t i = 0; i <= segments; ++i) {
        const double t = double(i) * step;
        const glm::dvec3 axis = glm::normalize(at(t + 0.5 * step) - at(t - 0.5 * step));
        rings[i] = {at(t), axis, radius * (1 - 0.95 * t)};
    }
    rings.back().radius = 0;
    return rings;
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto bundle = static_cast<std::size_t>(settings.integer("bundle"));
    const auto segments = static_cast<std::size_t>(settings.integer("segments"));
    const auto sides = static_cast<std::size_t>(settings.integer("sides"));
    const double wave = settings.real("wave"), phase = settings.real("phase");
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    GeneratedScene scene;
    const std::size_t each = sides * (2 * segments - 1) + sides - 2;
    const std::size_t count = (triangles - 2 + each - 1) / each;
    scene.mesh.triangles.reserve(count * each + 2);
    scene.mesh.positions.reserve(count * (sides * segments + 1) + 4);
    // The more tentacles, the thinner they and the larger the floor, so that light still finds its
    // way between them: their number times their radius grows like the floor.
    const double root = std::sqrt(std::sqrt(double(count)));
    const double radius = std::min(0.1, 0.3 / root),
                 floor = std::max(2.5, 0.7 * root * std::sqrt(root));
    const double spread = std::min(0.8, 1.5 * radius * std::sqrt(double(bundle)));
    glm::dvec2 middle(0);
    for (std::size_t i = 0; i < count; ++i) {
        if (i % bundle == 0) {
            const double edge = floor - 1.3;
            middle = {random.uniform(-edge, edge), random.uniform(-edge, edge)};
        }
        const glm::dvec2 away = std::sqrt(random.uniform()) * unit_circle(random.uniform());
        add_tube(scene.mesh,
                 tentacle(random, middle + spread * away, 0.9 * away,
                          radius * random.uniform(0.7, 1.3), segments, wave, phase),
                 sides);
    }
    add_ground(scene.mesh, floor);

    const auto size = static_cast<float>(floor);
    scene.camera = {
        {0.62f * size, 1.8f + 0.36f * size, 1.3f * size}, {0, 0.8f, 0.08f * size}, {0, 1, 0}, 50};
    scene.light = {structures::geometry::Light::Type::point,
                   {-0.9f * size, 3 + 0.8f * size, 0.7f * size}};
    return scene;
}

}  // namespace

GeneratorRow tentacles() {
    return {"tentacles", "bundles of long tentacles that wave over a floor", &parameters,
            &generate};
}

}  // namespace experiments::scenes
