// An experiment as a config file describes it: checked, sweeps expanded, paths absolute.
//
//     Config config = load("quickstart.toml", {"experiment.repeat=3"}, catalogue);
//     for (const Scene& scene : config.scenes)
//         for (const Method& method : config.methods) ...
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/catalogue.hpp"
#include "experiments/config/node.hpp"
#include "experiments/config/stability.hpp"
#include "experiments/scenes/path.hpp"
#include "experiments/scenes/views_file.hpp"
#include "structures/geometry/light.hpp"

namespace experiments::config {

struct Scene {
    std::string name;                 ///< unique in the config; the `scene` column of the results
    std::filesystem::path file;       ///< empty: generated
    std::string generator;            ///< empty: loaded
    structures::Settings settings{};  ///< of the generator
    std::optional<scenes::Camera> camera{};  ///< absent: the scene's own view
    std::optional<structures::geometry::Light> light{};
    std::filesystem::path views{};       ///< file of named views, or empty
    std::string view{};                  ///< the view of that file
    std::optional<scenes::Path> path{};  ///< kind "shadows": goes before camera, light and view
    bool all_pictures = false;           ///< of every frame, not the first alone
    std::uint32_t width = 1280, height = 720;

    int frames() const { return path ? path->frames : 1; }
};

struct Method {
    std::string name;     ///< of the registry
    std::string variant;  ///< unique together with `name`
    structures::Settings settings{};

    /// "bvh query=lane", also "bvh default".
    std::string label() const { return name + " " + variant; }
};

struct Config {
    std::filesystem::path file;
    std::string name;
    std::string kind;  ///< "shadows", "build" or "stability"
    int repeat = 5;
    int warmup = 1;
    std::int64_t seed = 1;
    bool truth = true;          ///< kind "shadows": judge every answer by shadows/truth
    bool pictures = true;       ///< kind "shadows": draw every answer
    std::size_t reference = 0;  ///< kind "shadows": index of the method to compare answers with
    std::vector<Scene> scenes;  ///< none for kind "stability", which has its own
    std::vector<Method> methods;
    std::optional<stability::Selection> stability{};  ///< for kind "stability" alone
};

/// Kinds of experiment that this version can run.
const std::vector<std::string>& kinds();

/// Reads `file`, applies the `--set` assignments in order, checks everything that can be checked
/// without a device or a scene. Throws ConfigError.
Config load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
            const Catalogue& catalogue);
/// The same for a document already read.
Config resolve(const Node& root, const std::filesystem::path& file, const Catalogue& catalogue);

/// Everything that decides what is measured, keys sorted: equal experiments give equal text.
nlohmann::json to_json(const Config& config);

}  // namespace experiments::config
