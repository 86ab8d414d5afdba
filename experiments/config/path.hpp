// `path` of a scene: the way of its camera and light, the keys written in place or in a JSON file.
#pragma once

#include <nlohmann/json.hpp>

#include "experiments/config/node.hpp"
#include "experiments/scenes/path.hpp"

namespace experiments::config {

struct Animation {
    scenes::Path path;
    bool all_pictures = false;
};

/// Throws ConfigError naming the place of what is wrong, a key of the file included.
Animation read_path(const Node& node);
nlohmann::json to_json(const scenes::Path& path);

}  // namespace experiments::config
