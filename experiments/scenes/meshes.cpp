// Rows of densely tessellated creatures on a floor behind a fence of thin bars: most triangles are
// smaller than a pixel, and the bars cast long, thin shadows over them.
#include <algorithm>
#include <array>

#include "experiments/scenes/creatures.hpp"
#include "experiments/scenes/generator_rows.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;
using structures::geometry::TriangleMesh;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("sets how finely the creatures are tessellated"),
        {"rows", std::int64_t{3}, "rows of creatures", {}, 1, 100},
        {"columns",
         std::int64_t{6},
         "creatures in a row; there are fewer in all where triangles do not suffice",
         {},
         1,
         100},
        {"bars", std::int64_t{80}, "bars of the fence, at most (0: no fence)", {}, 0, 5000},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

constexpr double kColumn = 3.2, kRow = 4;  // distances
constexpr double kFenceHeight = 2.6;
constexpr std::size_t kBarSides = 8;
constexpr std::size_t kBarTriangles = 2 * kBarSides + 2 * (kBarSides - 2);

void add_rod(TriangleMesh& mesh, glm::dvec3 from, glm::dvec3 to, double radius) {
    const glm::dvec3 axis = glm::normalize(to - from);
    add_tube(mesh, std::array{Ring{from, axis, radius}, Ring{to, axis, radius}}, kBarSides);
}

/// Upright bars between two rails, along x at this z.
void add_fence(TriangleMesh& mesh, double half_width, double z, std::size_t bars) {
    const double pitch = 2 * half_width / double(bars);
    const double radius = std::min(0.03, 0.2 * pitch);
    for (std::size_t i = 0; i < bars; ++i) {
        const double x = -half_width + (double(i) + 0.5) * pitch;
        add_rod(mesh, {x, -0.02, z}, {x, kFenceHeight, z}, radius);
    }
    for (const double y : {0.3, 0.9 * kFenceHeight})
        add_rod(mesh, {-half_width, y, z}, {half_width, y, z}, 1.3 * radius);
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto rows = static_cast<std::size_t>(settings.integer("rows"));
    const auto columns = static_cast<std::size_t>(settings.integer("columns"));
    // The fence takes a fifth of the triangles at most.
    const std::size_t bars = std::min(static_cast<std::size_t>(settings.integer("bars")),
                                      triangles / (5 * kBarTriangles));
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    GeneratedScene scene;
    TriangleMesh& mesh = scene.mesh;
    mesh.triangles.reserve(triangles + triangles / 100 + 2 * kLeastCreature);
    mesh.positions.reserve(triangles / 2 + triangles / 100 + 2 * kLeastCreature);
    const double half_width = 0.5 * kColumn * double(columns) + 1;
    const double half_depth = 0.5 * kRow * double(rows);
    if (bars > 0) add_fence(mesh, half_width, half_depth + 0.5, bars);
    const double edge = std::max(half_width, half_depth) + 4;
    add_ground(mesh, edge);

    const std::size_t rest = triangles - mesh.triangle_count();
    const std::size_t count = std::clamp<std::size_t>(rest / kLeastCreature, 1, rows * columns);
    for (std::size_t i = 0; i < count && mesh.triangle_count() < triangles; ++i) {
        const TriangleMesh model = creature(static_cast<Species>(random.index(kSpecies)), random,
                                            (triangles - mesh.triangle_count()) / (count - i));
        // The front row first; they look towards the fence, more or less.
        const glm::dvec3 at((double(i % columns) + 0.5) * kColumn - half_width + 1, 0,
                            half_depth - kRow * (double(i / columns) + 0.5));
        add_copy(mesh, model, at, -0.25 + random.uniform(-0.12, 0.12));
    }

    const auto width = static_cast<float>(half_width), depth = static_cast<float>(half_depth);
    scene.camera = {{0.25f * width, 3.1f + 0.1f * depth, depth + 0.55f * width + 1},
                    {0, 0.5f, 0.1f * depth},
                    {0, 1, 0},
                    50};
    scene.light = {structures::geometry::Light::Type::point,
                   {-0.5f * width, 4.5f + 0.1f * depth, depth + 4}};
    return scene;
}

}  // namespace

GeneratorRow meshes() {
    return {"meshes", "rows of finely tessellated creatures behind a fence", &parameters,
            &generate};
}

}  // namespace experiments::scenes
