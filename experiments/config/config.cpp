#include "experiments/config/config.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/path.hpp"
#include "experiments/config/sections.hpp"
#include "experiments/config/table.hpp"
#include "experiments/config/view.hpp"

namespace experiments::config {
namespace {

constexpr const char* kLaterKinds[] = {"optimise", "trace", "collide"};

/// The tables of `[[key]]`. Fails if there is none.
const std::vector<Node>& list_of_tables(Table& root, const std::string& key) {
    const Node* list = root.find(key);
    if (!list) fail(root.node(), fmt::format("there is no [[{}]]; expected at least one", key));
    if (list->kind != Node::Kind::array || list->items.empty())
        fail(*list, fmt::format("'{}' is {}; expected a list of tables, [[{}]]", key,
                                describe(*list), key));
    return list->items;
}

std::string read_kind(Table& table) {
    std::string kind = table.required("kind", table.text("kind"));
    const auto contains = [&](const auto& list) {
        return std::find(std::begin(list), std::end(list), kind) != std::end(list);
    };
    if (contains(kinds())) return kind;
    const std::string available = fmt::format("{}", fmt::join(kinds(), ", "));
    if (contains(kLaterKinds))
        fail(*table.find("kind"),
             fmt::format("kind '{}' is not available in this version; available: {}", kind,
                         available));
    fail(*table.find("kind"), unknown("kind", kind, kinds()));
}

/// The first method called `name` ("bvh") or "name variant" ("bvh query=lane").
std::size_t find_reference(const Config& config, const std::string& name, const Node& where) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < config.methods.size(); ++i) {
        const Method& method = config.methods[i];
        if (method.name == name || method.label() == name) return i;
        known.push_back(method.name);
    }
    fail(where, unknown("reference method", name, known));
}

/// Labels become cells of a table of one line per row, and parts of file names.
void check_labels(const Config& config, const Node& where) {
    const auto check = [&](const std::string& label) {
        for (unsigned char c : label)
            if (c < 0x20 || c == 0x7f)
                fail(where,
                     "a 'name' or 'variant' holds a line break or another control character");
        if (label.empty()) fail(where, "a 'name' or 'variant' is empty");
    };
    for (const Scene& scene : config.scenes) check(scene.name);
    for (const Method& method : config.methods) check(method.variant);
}

void check_unique(const Config& config, const Node& where) {
    for (std::size_t i = 0; i < config.scenes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (config.scenes[i].name == config.scenes[j].name)
                fail(where, fmt::format("two scenes are called '{}'; give each [[scene]] a 'name'",
                                        config.scenes[i].name));
    for (std::size_t i = 0; i < config.methods.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (config.methods[i].name == config.methods[j].name &&
                config.methods[i].variant == config.methods[j].variant)
                fail(where, fmt::format("method '{}' occurs twice as variant '{}'; give each a "
                                        "'variant'",
                                        config.methods[i].name, config.methods[i].variant));
}

nlohmann::json settings_json(const structures::Settings& settings) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [key, value] : settings.values())
        json[key] = std::visit([](const auto& v) { return nlohmann::json(v); }, value);
    return json;
}

nlohmann::json scene_json(const Scene& scene) {
    nlohmann::json json = {{"name", scene.name}, {"resolution", {scene.width, scene.height}}};
    if (!scene.file.empty()) json["file"] = scene.file.string();
    if (!scene.generator.empty()) {
        json["generator"] = scene.generator;
        json["settings"] = settings_json(scene.settings);
    }
    if (!scene.views.empty()) json["views"] = scene.views.string();
    if (!scene.view.empty()) json["view"] = scene.view;
    if (scene.camera) json["camera"] = to_json(*scene.camera);
    if (scene.light) json["light"] = to_json(*scene.light);
    if (scene.path) {
        json["path"] = to_json(*scene.path);
        json["path"]["pictures"] = scene.all_pictures;
    }
    return json;
}

}  // namespace

const std::vector<std::string>& kinds() {
    static const std::vector<std::string> list = {"shadows", "build", "stability"};
    return list;
}

Config resolve(const Node& root, const std::filesystem::path& file, const Catalogue& catalogue) {
    Config config;
    config.file = file;
    Table document(root, "the config");
    const Node* experiment = document.find("experiment");
    if (!experiment) fail(root, "there is no [experiment]; expected one with 'name' and 'kind'");
    Table table(*experiment, "[experiment]");
    config.name = table.text("name").value_or(file.stem().string());
    if (config.name.empty() || config.name.find_first_of("/\\\n") != std::string::npos ||
        config.name.front() == '.')
        fail(*table.find("name"),
             "'name' becomes the name of a folder; expected letters, digits, "
             "dashes and underscores");
    config.kind = read_kind(table);
    config.seed = table.integer("seed", 0, INT64_MAX).value_or(config.seed);
    std::optional<std::string> reference;
    if (config.kind == "stability") {
        config.stability = read_stability(table);
        config.repeat = 1;
        config.warmup = 0;
    } else {
        config.repeat = int(table.integer("repeat", 1, 100000).value_or(config.repeat));
        config.warmup = int(table.integer("warmup", 0, 100000).value_or(config.warmup));
    }
    if (config.kind == "shadows") {
        config.truth = table.boolean("truth").value_or(config.truth);
        config.pictures = table.boolean("pictures").value_or(config.pictures);
        reference = table.text("reference");
    }
    table.finish();

    if (!config.stability)
        for (const Node& node : list_of_tables(document, "scene")) {
            read_scenes(node, catalogue, config.seed, config.scenes);
            if (const Node* path = node.find("path"); path && config.kind != "shadows")
                fail(*path, "'path' is a key of kind 'shadows' alone; leave it out");
        }
    else if (const Node* scene = document.find("scene"))
        fail(*scene, "kind 'stability' has scenes of its own; remove [[scene]]");
    const bool shadows = config.kind != "build";
    for (const Node& node : list_of_tables(document, "method"))
        read_methods(node, shadows ? catalogue.methods : catalogue.structures,
                     shadows ? "shadow method" : "structure", config.methods);
    document.finish();
    check_labels(config, root);
    check_unique(config, root);
    if (reference) config.reference = find_reference(config, *reference, *table.find("reference"));
    return config;
}

Config load(const std::filesystem::path& file, const std::vector<std::string>& assignments,
            const Catalogue& catalogue) {
    Node root = parse_file(file);
    for (const std::string& assignment : assignments) override_value(root, assignment);
    return resolve(root, file, catalogue);
}

nlohmann::json to_json(const Config& config) {
    nlohmann::json json = {{"name", config.name},
                           {"kind", config.kind},
                           {"repeat", config.repeat},
                           {"warmup", config.warmup},
                           {"seed", config.seed},
                           {"truth", config.truth},
                           {"pictures", config.pictures},
                           {"scenes", nlohmann::json::array()},
                           {"methods", nlohmann::json::array()}};
    json["reference"] = config.methods[config.reference].label();
    if (config.stability) json["stability"] = to_json(*config.stability);
    for (const Scene& scene : config.scenes) json["scenes"].push_back(scene_json(scene));
    for (const Method& method : config.methods)
        json["methods"].push_back({{"name", method.name},
                                   {"variant", method.variant},
                                   {"settings", settings_json(method.settings)}});
    return json;
}

}  // namespace experiments::config
