// Cameras and lights as configs write them.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/config/table.hpp"
#include "experiments/scenes/camera.hpp"
#include "structures/geometry/light.hpp"

namespace experiments::config {

/// The keys eye, target, up and fov_y_degrees of `table`, checked; the caller finishes the table.
scenes::Camera read_camera(Table& table);
/// A table of type with position or direction.
structures::geometry::Light read_light(const Node& node);

nlohmann::json to_json(const scenes::Camera& camera);
nlohmann::json to_json(const structures::geometry::Light& light);

}  // namespace experiments::config
