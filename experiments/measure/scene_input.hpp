// Turns the scene of a config into triangles, a camera and a light.
#pragma once

#include "experiments/config/config.hpp"
#include "experiments/scenes/mesh_file.hpp"

namespace experiments::measure {

struct SceneInput {
    structures::geometry::TriangleMesh mesh;
    scenes::LoadReport report;
    scenes::Camera camera;
    structures::geometry::Light light;
};

/// Loads or generates. A camera or light that the config does not give is the generator's, or one
/// that shows the whole mesh. Throws std::runtime_error, one line naming the file and the remedy.
SceneInput load_scene(const config::Scene& scene);

}  // namespace experiments::measure
