// Named views from JSON.
#include "experiments/scenes/views_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using nlohmann::json;
using structures::geometry::Light;

/// `object[key]`, or an error that lists what there is.
const json& entry(const json& object, const std::string& key, const std::string& kind) {
    if (object.is_object() && object.contains(key)) return object[key];
    std::vector<std::string> names;
    if (object.is_object())
        for (const auto& [name, value] : object.items()) names.push_back(name);
    throw FormatError(
        fmt::format("has no {} '{}'; there are: {}", kind, key, fmt::join(names, ", ")));
}

glm::vec3 vector(const json& object, const char* key) {
    const auto v = object.at(key).get<std::array<float, 3>>();
    return {v[0], v[1], v[2]};
}

View parse_view(const json& description) {
    View view;
    const json& camera = description.at("camera");
    view.camera.eye = vector(camera, "eye");
    view.camera.target = vector(camera, "target");
    if (camera.contains("up")) view.camera.up = vector(camera, "up");
    view.camera.fov_y_degrees = camera.value("fov_y_degrees", view.camera.fov_y_degrees);
    if (const std::string fault = view.camera.fault(); !fault.empty()) throw FormatError(fault);

    const json& light = description.at("light");
    const std::string type = light.at("type");
    if (type == "point")
        view.light = {Light::Type::point, vector(light, "position")};
    else if (type == "directional")
        view.light = {Light::Type::directional, vector(light, "direction")};
    else
        throw FormatError(fmt::format("light type '{}' is neither point nor directional", type));
    const glm::vec3 v = view.light.vector;
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw FormatError("the light's coordinates are not finite");
    if (view.light.type == Light::Type::directional && v == glm::vec3(0))
        throw FormatError("the light's direction has no length");
    return view;
}

json read_views(const std::filesystem::path& path, const std::string& scene) {
    const json root = json::parse(read_bytes(path, false));
    const json& scenes = entry(root, "scenes", "entry");
    return entry(entry(scenes, scene, "scene"), "views", "entry");
}

}  // namespace

View load_view(const std::filesystem::path& path, const std::filesystem::path& scene_file,
               const std::string& view) {
    const std::string scene = scene_file.filename().string();
    const std::string where = fmt::format("scene '{}', view '{}': ", scene, view);
    std::string place;  // put in front of errors once the view is found
    try {
        const json views = read_views(path, scene);
        const json& description = entry(views, view, fmt::format("view of '{}' called", scene));
        place = where;
        return parse_view(description);
    } catch (const FormatError& error) {
        throw LoadError(path, place + error.what());
    } catch (const json::exception& error) {
        throw LoadError(path, fmt::format("{}malformed: {}", place, error.what()));
    }
}

std::vector<std::string> view_names(const std::filesystem::path& path,
                                    const std::filesystem::path& scene_file) {
    try {
        const json views = read_views(path, scene_file.filename().string());
        std::vector<std::string> names;
        for (const auto& [name, view] : views.items()) names.push_back(name);
        return names;
    } catch (const FormatError& error) {
        throw LoadError(path, error.what());
    } catch (const json::exception& error) {
        throw LoadError(path, fmt::format("malformed: {}", error.what()));
    }
}

}  // namespace experiments::scenes
