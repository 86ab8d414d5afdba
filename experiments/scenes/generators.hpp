// Seeded scenes of any size. The same settings give the same mesh, bit for bit, on every platform:
// random numbers, sines and cosines are our own, everything else is correctly rounded arithmetic.
//
//     for (const GeneratorRow& row : generators()) {
//         Settings settings = Settings::resolve(row.parameters(), {{"triangles", 1'000'000}});
//         GeneratedScene scene = row.generate(settings);   // mesh, camera, light
//     }
//
// All take `triangles` (how many to make, reached to within one object or one step of tessellation)
// and `seed`. No triangle is degenerate.
#pragma once

#include <span>
#include <string_view>

#include "experiments/scenes/camera.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "structures/parameters.hpp"

namespace experiments::scenes {

struct GeneratedScene {
    structures::geometry::TriangleMesh mesh;
    Camera camera;                      ///< default view
    structures::geometry::Light light;  ///< default light, a point
};

struct GeneratorRow {
    std::string_view name;
    std::string_view summary;
    std::span<const structures::Parameter> (*parameters)();
    /// Throws structures::SettingError if the settings contradict each other.
    GeneratedScene (*generate)(const structures::Settings& settings);
};

std::span<const GeneratorRow> generators();

}  // namespace experiments::scenes
