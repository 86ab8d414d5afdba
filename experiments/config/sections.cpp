#include "experiments/config/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/path.hpp"
#include "experiments/config/sweep.hpp"
#include "experiments/config/table.hpp"
#include "experiments/config/view.hpp"

namespace experiments::config {
namespace {

void read_resolution(Table& table, Scene& scene) {
    const Node* node = table.find("resolution");
    if (!node) return;
    const auto side = [&](const Node& item) {
        const auto* value = std::get_if<std::int64_t>(&item.scalar);
        if (item.kind != Node::Kind::scalar || !value || *value < 1 || *value > 4096)
            fail(item, "'resolution' must hold two integers from 1 to 4096, [width, height]");
        return std::uint32_t(*value);
    };
    if (node->kind != Node::Kind::array || node->items.size() != 2)
        fail(*node, fmt::format("'resolution' is {}; expected [width, height]", describe(*node)));
    scene.width = side(node->items[0]);
    scene.height = side(node->items[1]);
}

/// The keys that a [[scene]] or [[method]] does not know itself go to the generator or method.
structures::Settings read_settings(Table& table, const Entry& entry,
                                   std::map<std::string, structures::Value> given = {}) {
    for (const std::string& key : table.unread()) {
        const Node& node = *table.find(key);
        if (node.kind != Node::Kind::scalar)
            fail(node, fmt::format("'{}' is {}; expected a single value", key, describe(node)));
        given[key] = node.scalar;
    }
    try {
        return structures::Settings::resolve(entry.parameters, given);
    } catch (const structures::SettingError& error) {
        const Node* node = table.find(error.key);
        fail(node ? *node : table.node(), error.what() + (" (of '" + entry.name + "')"));
    }
}

bool has_parameter(const Entry& entry, std::string_view name) {
    return std::any_of(entry.parameters.begin(), entry.parameters.end(),
                       [&](const structures::Parameter& p) { return p.name == name; });
}

void read_generator(Table& table, const Catalogue& catalogue, std::int64_t seed, Scene& scene) {
    const Entry* entry = find(catalogue.generators, scene.generator);
    if (!entry)
        fail(*table.find("generator"),
             unknown("generator", scene.generator, names(catalogue.generators)));
    std::map<std::string, structures::Value> given;
    if (has_parameter(*entry, "seed")) given["seed"] = seed;
    scene.settings = read_settings(table, *entry, given);
}

/// "sponza" for "path/to/sponza.ply.gz".
std::string stem(std::filesystem::path file) {
    if (file.extension() == ".gz") file = file.stem();
    return file.stem().string();
}

Scene read_scene(const Combination& combination, const Catalogue& catalogue, std::int64_t seed) {
    Table table(combination.table, "[[scene]]");
    Scene scene;
    scene.file = table.path("file").value_or("");
    scene.generator = table.text("generator").value_or("");
    if (scene.file.empty() == scene.generator.empty())
        fail(table.node(),
             "[[scene]] needs either 'file' or 'generator'; "
             "e.g. --set scene.0.file=sponza.ply");
    if (!scene.file.empty() && !std::filesystem::is_regular_file(scene.file))
        fail(*table.find("file"),
             fmt::format("scene file '{}' does not exist; check the path", scene.file.string()));
    const auto name = table.text("name");
    if (const Node* camera = table.find("camera")) {
        Table keys(*camera, "'camera'");
        scene.camera = read_camera(keys);
        keys.finish();
    }
    if (const Node* light = table.find("light")) scene.light = read_light(*light);
    scene.views = table.path("views").value_or("");
    scene.view = table.text("view").value_or("");
    read_resolution(table, scene);
    if (const Node* path = table.find("path")) {
        const Animation animation = read_path(*path);
        scene.path = animation.path;
        scene.all_pictures = animation.all_pictures;
        const scenes::Keyframe& key = scene.path->keys[0];
        if ((key.camera && scene.camera) || (key.light && scene.light))
            fail(*path, fmt::format("'path' excludes '{0}': its keys have {0}s",
                                    key.camera && scene.camera ? "camera" : "light"));
    }
    if (!scene.view.empty() && scene.views.empty())
        fail(*table.find("view"), "'view' names a view of the file 'views', which is not given");
    if (!scene.views.empty() && (scene.camera || scene.light))
        fail(*table.find("views"), "'views' excludes 'camera' and 'light'; give one or the other");
    if (!scene.views.empty() && scene.file.empty())
        fail(*table.find("views"), "'views' needs 'file': views belong to scene files");
    scene.generator.empty() ? table.finish() : read_generator(table, catalogue, seed, scene);

    scene.name = name ? *name : scene.file.empty() ? scene.generator : stem(scene.file);
    const std::string label = sweep_label(combination, {"file", "generator", "name", "view"});
    if (!label.empty()) scene.name += "," + label;
    return scene;
}

std::vector<std::string> view_names(const Scene& scene, const Node& node) {
    try {
        return scenes::view_names(scene.views, scene.file);
    } catch (const std::exception& error) {
        fail(*node.find("views"), error.what());
    }
}

/// Replaces camera and light by those of the view; checks that it exists.
void take_view(Scene& scene, const std::string& name, const Node& node) {
    const std::vector<std::string> known = view_names(scene, node);
    if (std::find(known.begin(), known.end(), name) == known.end())
        fail(*node.find("view"), unknown("view", name, known));
    const scenes::View view = scenes::load_view(scene.views, scene.file, name);
    scene.view = name;
    scene.name += "/" + name;
    scene.camera = view.camera;
    scene.light = view.light;
}

/// What the config calls the method, or "key=value" of each key that differs from the method's
/// default; and of each swept key, which tell the combinations of one table apart.
std::string label(const Entry& entry, const structures::Settings& settings,
                  const Combination& combination, const std::optional<std::string>& variant) {
    std::vector<std::string> parts;
    if (variant) parts.push_back(*variant);
    for (const structures::Parameter& p : entry.parameters) {
        const structures::Value& value = settings.values().at(p.name);
        const auto& swept = combination.swept;
        if ((!variant && value != p.fallback) ||
            std::find(swept.begin(), swept.end(), p.name) != swept.end())
            parts.push_back(p.name + "=" + structures::to_string(value));
    }
    return parts.empty() ? "default" : fmt::format("{}", fmt::join(parts, ","));
}

}  // namespace

void read_scenes(const Node& node, const Catalogue& catalogue, std::int64_t seed,
                 std::vector<Scene>& scenes) {
    if (node.kind != Node::Kind::table)
        fail(node,
             fmt::format("'scene' holds {}; expected a list of tables, [[scene]]", describe(node)));
    for (const Combination& combination : expand(node, "resolution")) {
        const Scene scene = read_scene(combination, catalogue, seed);
        if (scene.views.empty()) {
            scenes.push_back(scene);
            continue;
        }
        std::vector<std::string> views{scene.view};
        if (scene.view.empty()) views = view_names(scene, combination.table);
        for (const std::string& view : views) {
            scenes.push_back(scene);
            take_view(scenes.back(), view, combination.table);
        }
    }
}

void read_methods(const Node& node, const Entries& entries, const std::string& what,
                  std::vector<Method>& methods) {
    if (node.kind != Node::Kind::table)
        fail(node, fmt::format("'method' holds {}; expected a list of tables, [[method]]",
                               describe(node)));
    for (const Combination& combination : expand(node)) {
        Table table(combination.table, "[[method]]");
        Method method;
        method.name = table.required("name", table.text("name"));
        const auto variant = table.text("variant");
        const Entry* entry = find(entries, method.name);
        if (!entry) fail(*table.find("name"), unknown(what, method.name, names(entries)));
        method.settings = read_settings(table, *entry);

        method.variant = label(*entry, method.settings, combination, variant);
        methods.push_back(std::move(method));
    }
}

}  // namespace experiments::config
