#include "experiments/config/view.hpp"

namespace experiments::config {
namespace {

using structures::geometry::Light;

nlohmann::json list(const glm::vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

scenes::Camera read_camera(Table& table) {
    scenes::Camera camera;
    camera.eye = table.required("eye", table.vector("eye"));
    camera.target = table.required("target", table.vector("target"));
    camera.up = table.vector("up").value_or(camera.up);
    camera.fov_y_degrees = float(table.real("fov_y_degrees").value_or(camera.fov_y_degrees));
    if (const std::string fault = camera.fault(); !fault.empty())
        fail(table.node(), table.title() + ": " + fault);
    return camera;
}

Light read_light(const Node& node) {
    Table table(node, "'light'");
    const std::string type = table.required("type", table.choice("type", {"point", "directional"}));
    const bool point = type == "point";
    const std::string key = point ? "position" : "direction";
    const Light light{point ? Light::Type::point : Light::Type::directional,
                      table.required(key, table.vector(key))};
    table.finish();
    if (!point && light.vector == glm::vec3(0)) fail(node, "'direction' must not be zero");
    return light;
}

nlohmann::json to_json(const scenes::Camera& camera) {
    return {{"eye", list(camera.eye)},
            {"target", list(camera.target)},
            {"up", list(camera.up)},
            {"fov_y_degrees", camera.fov_y_degrees}};
}

nlohmann::json to_json(const Light& light) {
    return light.type == Light::Type::point
               ? nlohmann::json{{"type", "point"}, {"position", list(light.vector)}}
               : nlohmann::json{{"type", "directional"}, {"direction", list(light.vector)}};
}

}  // namespace experiments::config
