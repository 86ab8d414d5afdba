// Reads a camera and light from a file of named views, one list per scene file:
//
//     {"scenes": {"sponza.ply.gz": {"views": {"atrium": {
//         "camera": {"eye": [x, y, z], "target": [..], "up": [..], "fov_y_degrees": 60},
//         "light": {"type": "point", "position": [x, y, z]}}}}}}
//
// A directional light has "type": "directional" and "direction": [..], the way the light travels.
// "fov_y_degrees" (45) and "up" (y) may be left out; other keys are ignored.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/scenes/camera.hpp"
#include "experiments/scenes/load_error.hpp"

namespace experiments::scenes {

/// The view `view` of the scene whose file name (last part of `scene_file`) is in `path`. Throws
/// LoadError naming the file and what is missing in it, with the scenes or views that are there.
View load_view(const std::filesystem::path& path, const std::filesystem::path& scene_file,
               const std::string& view);

/// The names of all views of that scene, in alphabetical order. Throws LoadError as load_view().
std::vector<std::string> view_names(const std::filesystem::path& path,
                                    const std::filesystem::path& scene_file);

}  // namespace experiments::scenes
