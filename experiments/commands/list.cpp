// grove list
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/commands/program.hpp"
#include "experiments/config/table.hpp"
#include "experiments/measure/metrics.hpp"
#include "experiments/measure/provenance.hpp"

namespace experiments::commands {
namespace {

using nlohmann::json;

json to_json(const structures::Value& value) {
    return std::visit([](const auto& v) { return json(v); }, value);
}

json to_json(const structures::Parameter& p) {
    static constexpr const char* kTypes[] = {"boolean", "integer", "number", "string"};
    json entry = {{"name", p.name},
                  {"type", kTypes[p.fallback.index()]},
                  {"default", to_json(p.fallback)},
                  {"help", p.help}};
    if (!p.choices.empty()) entry["choices"] = p.choices;
    if (std::isfinite(p.minimum)) entry["minimum"] = p.minimum;
    if (std::isfinite(p.maximum)) entry["maximum"] = p.maximum;
    return entry;
}

json entries_list(const config::Entries& entries) {
    json list = json::array();
    for (const config::Entry& entry : entries) {
        json keys = json::array();
        for (const structures::Parameter& p : entry.parameters) keys.push_back(to_json(p));
        list.push_back({{"name", entry.name}, {"summary", entry.summary}, {"keys", keys}});
    }
    return list;
}

/// The configs that come with the source. One that cannot be resolved as it is (a template that
/// wants a scene, say) is listed all the same.
json experiments_list() {
    const std::filesystem::path folder =
        std::filesystem::path(measure::source_folder()) / "experiments/configs";
    std::vector<std::filesystem::path> files;
    std::error_code code;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, code))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    json list = json::array();
    for (const auto& file : files) {
        const config::Node root = config::parse_file(file);
        const config::Node* experiment = root.find("experiment");
        if (!experiment) continue;
        config::Table table(*experiment, "[experiment]");
        list.push_back({{"name", table.text("name").value_or(file.stem().string())},
                        {"summary", table.text("kind").value_or("?") + ", " + file.string()},
                        {"kind", table.text("kind").value_or("?")},
                        {"file", file.string()}});
    }
    return list;
}

json devices_list() {
    json list = json::array();
    for (const auto& device : taskpool::gpu::list_devices())
        list.push_back({{"name", device.name},
                        {"summary", fmt::format("{}, {}{}", to_string(device.type), device.driver,
                                                device.usable() ? "" : ", lacks what grove needs")},
                        {"driver", device.driver},
                        {"type", to_string(device.type)},
                        {"subgroup_size", device.subgroup_size},
                        {"memory_bytes", device.memory_bytes},
                        {"usable", device.usable()},
                        {"missing", device.missing}});
    for (std::size_t i = 0; i < list.size(); ++i) list[i]["index"] = i;
    return list;
}

json metrics_list() {
    static constexpr const char* kBetter[] = {"lower", "higher", "neither"};
    json list = json::array();
    for (const measure::Metric& metric : measure::metrics())
        list.push_back({{"name", metric.name},
                        {"summary", fmt::format("[{}] {}", metric.unit, metric.meaning)},
                        {"unit", metric.unit},
                        {"better", kBetter[int(metric.better)]}});
    return list;
}

}  // namespace

int list(const std::string& what, bool as_json, const measure::Registries& registries) {
    const config::Catalogue catalogue =
        config::make_catalogue(registries.structures, registries.methods);
    json entries;
    if (what == "structures")
        entries = entries_list(catalogue.structures);
    else if (what == "shadows")
        entries = entries_list(catalogue.methods);
    else if (what == "scenes")
        entries = entries_list(catalogue.generators);
    else if (what == "experiments")
        entries = experiments_list();
    else if (what == "devices")
        entries = devices_list();
    else if (what == "metrics")
        entries = metrics_list();
    else
        throw config::ConfigError("list: " +
                                  config::unknown("kind of thing", what,
                                                  {"structures", "shadows", "scenes", "experiments",
                                                   "devices", "metrics"}));
    if (as_json) {
        fmt::print("{}\n", entries.dump(2));
        return 0;
    }
    std::vector<std::vector<std::string>> rows;
    for (const json& entry : entries) {
        std::string name = entry.at("name");
        if (entry.contains("index")) name = fmt::format("{}  {}", entry["index"].dump(), name);
        rows.push_back({name, entry.at("summary")});
    }
    fmt::print("{}", text_table(rows, 2));
    return 0;
}

}  // namespace experiments::commands
