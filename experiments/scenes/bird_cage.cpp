// Birds in a cage: thin vertical bars that meet in a dome, hoops around them, a round base on a
// floor. A lamp beside the cage throws the bars' shadows over the birds and the floor.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "experiments/scenes/creatures.hpp"
#include "experiments/scenes/generator_rows.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;
using structures::geometry::TriangleMesh;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("sets how finely everything is tessellated"),
        {"bars", std::int64_t{48}, "bars, at most", {}, 3, 2000},
        {"hoops", std::int64_t{5}, "hoops around them, at most", {}, 0, 200},
        {"birds", std::int64_t{9}, "birds, at most", {}, 1, 60},
        {"thickness", 0.012, "radius of a bar; that of the cage is 1", {}, 0.001, 0.05},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

constexpr double kFoot = 0.1;      // top of the base
constexpr double kShoulder = 1.6;  // where the dome begins
constexpr double kDome = 0.8;      // its height
constexpr std::size_t kPerches = 2;
constexpr double kPerch = 0.02;  // their radius

/// Middle of a perch; they run along x, the lowest is 1.
glm::dvec3 perch(std::size_t level) {
    return {0, kFoot + 0.55 * double(level), 0.9 - 0.6 * double(level)};
}

/// Tessellation of a bar or a hoop.
struct Wire {
    explicit Wire(double triangles)
        : sides(static_cast<std::size_t>(std::clamp(std::sqrt(triangles / 12), 3.0, 24.0))),
          steps(static_cast<std::size_t>(std::clamp(triangles / double(2 * sides), 4.0, 512.0))) {}
    std::size_t sides, steps;
};

/// Straight up, then along a quarter of an ellipse.
void add_bar(TriangleMesh& mesh, glm::dvec2 out, double thickness, Wire wire) {
    const auto at = [&](double distance, double height) {
        return glm::dvec3(distance * out.x, height, distance * out.y);
    };
    const glm::dvec3 up(0, 1, 0);
    std::vector<Ring> rings = {{at(1, kFoot - 0.02), up, thickness}};
    for (std::size_t k = 0; k <= wire.steps; ++k) {
        const glm::dvec2 c = unit_circle(0.235 * double(k) / double(wire.steps));
        rings.push_back(
            {at(c.x, kShoulder + kDome * c.y), glm::normalize(at(-c.y, kDome * c.x)), thickness});
    }
    add_tube(mesh, rings, wire.sides);
}

/// The bars and hoops take about a third of the triangles; coarse cages have fewer of them.
void add_cage(TriangleMesh& mesh, const Settings& settings, double triangles) {
    const auto at_most = [&](const char* name, double count) {
        return std::min(static_cast<std::size_t>(settings.integer(name)),
                        static_cast<std::size_t>(count));
    };
    const double thickness = settings.real("thickness");
    const std::size_t bars = at_most("bars", 0.25 * triangles / 32);
    const Wire bar(0.25 * triangles / double(bars));
    for (std::size_t i = 0; i < bars; ++i)
        add_bar(mesh, unit_circle(double(i) / double(bars)), thickness, bar);
    const std::size_t hoops = at_most("hoops", 0.1 * triangles / 72);
    for (std::size_t i = 0; i < hoops; ++i) {
        const Wire hoop(0.1 * triangles / double(hoops));
        const double height = kShoulder - (kShoulder - kFoot) * double(i) / double(hoops);
        add_torus(mesh, {0, height, 0}, 1, 1.5 * thickness, hoop.steps, hoop.sides);
    }

    const auto segments =
        2 * static_cast<std::size_t>(std::clamp(std::sqrt(triangles) / 20, 4.0, 32.0));
    const glm::dvec3 up(0, 1, 0), along(1, 0, 0);
    add_sphere(mesh, {0, kShoulder + kDome, 0}, 0.12, segments);
    add_tube(mesh, std::array{Ring{{0, -0.02, 0}, up, 1.12}, Ring{{0, kFoot, 0}, up, 1.12}},
             4 * segments);
    for (std::size_t level = 1; level <= kPerches; ++level) {
        const glm::dvec3 middle = perch(level);
        add_tube(mesh,
                 std::array{Ring{middle - 0.94 * along, along, kPerch},
                            Ring{middle + 0.94 * along, along, kPerch}},
                 segments);
    }
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    GeneratedScene scene;
    TriangleMesh& mesh = scene.mesh;
    mesh.triangles.reserve(triangles + triangles / 100 + 2 * kLeastCreature);
    mesh.positions.reserve(triangles / 2 + triangles / 50 + 2 * kLeastCreature);
    add_cage(mesh, settings, static_cast<double>(triangles));
    add_ground(mesh, 6);

    // Birds by turns on the perches and on the floor of the cage.
    const auto left = [&] { return triangles - std::min(triangles, mesh.triangle_count()); };
    const std::size_t birds =
        std::clamp<std::size_t>(left() / kLeastCreature, 1, settings.integer("birds"));
    for (std::size_t i = 0; i < birds; ++i) {
        const TriangleMesh bird = creature(Species::bird, random, left() / (birds - i));
        const std::size_t levels = kPerches + 1, level = (i + 1) % levels;
        const double place =
            (double(i / levels) + random.uniform(0.3, 0.7)) / double((birds + levels - 1) / levels);
        const glm::dvec3 foot = level > 0 ? perch(level) + glm::dvec3(0, kPerch, 0)
                                          : glm::dvec3(0, kFoot, random.uniform(-0.4, 0.4));
        const glm::dvec3 at = foot + glm::dvec3(1.3 * place - 0.65, 0, 0);
        add_copy(mesh, bird, at, random.uniform(), 0.2 * random.uniform(0.8, 1.2));
    }

    scene.camera = {{1.6f, 2.3f, 4.4f}, {0.4f, 0.85f, 0}, {0, 1, 0}, 45};
    scene.light = {structures::geometry::Light::Type::point, {-2.6f, 3.6f, 1.4f}};
    return scene;
}

}  // namespace

GeneratorRow bird_cage() {
    return {"bird_cage", "birds behind the thin bars of a domed cage", &parameters, &generate};
}

}  // namespace experiments::scenes
