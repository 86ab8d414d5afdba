#include "experiments/config/path.hpp"

#include <fmt/format.h>

#include <fstream>

#include "experiments/config/view.hpp"

namespace experiments::config {
namespace {

constexpr int kMaxFrames = 100000;

/// JSON as the nodes that TOML gives; all of it is said to be written at `place`.
Node to_node(const nlohmann::json& json, const std::string& place) {
    Node node;
    node.place = place;
    if (json.is_object()) {
        for (const auto& [key, value] : json.items()) {
            node.keys.push_back(key);
            node.items.push_back(to_node(value, place));
        }
        return node;
    }
    node.kind = json.is_array() ? Node::Kind::array : Node::Kind::scalar;
    if (json.is_array())
        for (const nlohmann::json& value : json) node.items.push_back(to_node(value, place));
    else if (json.is_boolean())
        node.scalar = json.get<bool>();
    else if (json.is_number_integer())
        node.scalar = json.get<std::int64_t>();
    else if (json.is_number())
        node.scalar = json.get<double>();
    else
        node.scalar = json.is_string() ? json.get<std::string>() : json.dump();
    return node;
}

/// The list of keys in a file; each knows its number.
Node read_keys(const std::filesystem::path& file, const Node& where) {
    std::ifstream stream(file);
    if (!stream) fail(where, fmt::format("'{}' cannot be opened; check the path", file.string()));
    Node list{.kind = Node::Kind::array, .place = file.string()};
    try {
        const nlohmann::json json = nlohmann::json::parse(stream);
        if (!json.is_array()) fail(list, "is no list of keys, [{\"eye\": ..}, ..]");
        for (std::size_t i = 0; i < json.size(); ++i)
            list.items.push_back(to_node(json[i], fmt::format("{}: key {}", file.string(), i + 1)));
    } catch (const nlohmann::json::exception& error) {
        fail(list, fmt::format("is no JSON: {}", error.what()));
    }
    return list;
}

scenes::Keyframe read_key(const Node& node) {
    Table table(node, "a key of 'path'");
    scenes::Keyframe key;
    const bool still = !table.find("eye") && !table.find("target") && !table.find("up") &&
                       !table.find("fov_y_degrees");
    if (!still) key.camera = read_camera(table);
    if (const Node* light = table.find("light")) key.light = read_light(*light);
    table.finish();
    return key;
}

}  // namespace

Animation read_path(const Node& node) {
    Table table(node, "'path'");
    Animation animation;
    scenes::Path& path = animation.path;
    path.frames = int(table.required("frames", table.integer("frames", 1, kMaxFrames)));
    animation.all_pictures = table.boolean("pictures").value_or(false);
    const Node* keys = table.find("keys");
    if (!keys) fail(node, "'path' lacks the key 'keys'");
    const Node list =
        keys->kind == Node::Kind::array ? *keys : read_keys(*table.path("keys"), *keys);
    for (const Node& key : list.items) path.keys.push_back(read_key(key));
    table.finish();
    if (const std::string fault = path.fault(); !fault.empty()) fail(list, "'path': " + fault);
    return animation;
}

nlohmann::json to_json(const scenes::Path& path) {
    nlohmann::json keys = nlohmann::json::array();
    for (const scenes::Keyframe& key : path.keys) {
        nlohmann::json json = key.camera ? to_json(*key.camera) : nlohmann::json::object();
        if (key.light) json["light"] = to_json(*key.light);
        keys.push_back(std::move(json));
    }
    return {{"frames", path.frames}, {"keys", std::move(keys)}};
}

}  // namespace experiments::config
