// An N x N field of spheres over a ground plane: smooth closed casters, as silhouette methods are
// measured with. Each sphere has tessellation^2 triangles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/scenes/generator_rows.hpp"
#include "experiments/scenes/shapes.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        {"n", std::int64_t{10}, "spheres along each side of the field", {}, 1, 2000},
        {"tessellation",
         std::int64_t{32},
         "segments around a sphere, an even number; its square is the sphere's triangles",
         {},
         4,
         8192},
        {"triangles",
         std::int64_t{0},
         "triangles wanted; sets the tessellation to come nearest (0: as `tessellation` says)",
         {},
         0,
         kMaxTriangles},
        {"jitter", 0.5, "how far places and sizes stray from the grid, 0 to 1", {}, 0, 1},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

std::size_t tessellation_of(const Settings& settings) {
    const std::int64_t n = settings.integer("n"), triangles = settings.integer("triangles");
    std::int64_t tessellation = settings.integer("tessellation");
    if (triangles > 0) {
        const double per_sphere = static_cast<double>(triangles) / static_cast<double>(n * n);
        tessellation = 2 * std::lround(std::sqrt(per_sphere) / 2);
        if (tessellation < 4)
            throw structures::SettingError(
                "triangles", fmt::format("'triangles' is {}, but {} x {} spheres take at least {}: "
                                         "lower n",
                                         triangles, n, n, 16 * n * n));
    }
    if (tessellation % 2 != 0)
        throw structures::SettingError(
            "tessellation",
            fmt::format("'tessellation' is {}; expected an even number", tessellation));
    if (static_cast<double>(n * n) * static_cast<double>(tessellation * tessellation) >
        2 * kMaxTriangles)
        throw structures::SettingError(
            "tessellation",
            fmt::format("{} x {} spheres of {}^2 triangles are more than {:.0f}: lower n or "
                        "tessellation",
                        n, n, tessellation, 2 * kMaxTriangles));
    return static_cast<std::size_t>(tessellation);
}

GeneratedScene generate(const Settings& settings) {
    const auto n = static_cast<std::size_t>(settings.integer("n"));
    const std::size_t tessellation = tessellation_of(settings);
    const double jitter = settings.real("jitter");
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    GeneratedScene scene;
    scene.mesh.triangles.reserve(n * n * tessellation * tessellation + 2);
    scene.mesh.positions.reserve(n * n * (tessellation * tessellation / 2 + 2) + 4);
    // Cells are 1 wide and centred on the origin; the spheres float clear of the ground.
    const double half = 0.5 * static_cast<double>(n);
    for (std::size_t i = 0; i < n * n; ++i) {
        const double radius = 0.3 * (1 + jitter * random.uniform(-0.6, 0.5));
        const double stray = jitter * (0.5 - radius);
        const std::size_t column = i % n, row = i / n;
        const glm::dvec3 cell(static_cast<double>(column) + 0.5 - half, 0,
                              static_cast<double>(row) + 0.5 - half);
        const glm::dvec3 shift(random.uniform(-stray, stray),
                               radius + 0.05 + 0.4 * jitter * random.uniform(),
                               random.uniform(-stray, stray));
        add_sphere(scene.mesh, cell + shift, radius, tessellation);
    }
    const double edge = half + 1;
    add_ground(scene.mesh, edge);

    const auto size = static_cast<float>(edge);
    scene.camera = {{0.75f * size, 0.9f * size, 1.5f * size}, {0, 0, 0.1f * size}, {0, 1, 0}, 45};
    scene.light = {structures::geometry::Light::Type::point,
                   {-0.6f * size, 2 + 0.6f * size, -0.4f * size}};
    return scene;
}

}  // namespace

GeneratorRow spheres() {
    return {"spheres", "an n x n field of spheres over a ground plane", &parameters, &generate};
}

}  // namespace experiments::scenes
