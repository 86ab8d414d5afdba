#include "experiments/measure/run_folder.hpp"

#include <fmt/chrono.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>

#include "experiments/image/image.hpp"
#include "experiments/measure/digest.hpp"
#include "experiments/measure/provenance.hpp"

namespace experiments::measure {
namespace {

namespace fs = std::filesystem;
using config::ConfigError;

nlohmann::json to_json(const taskpool::gpu::DeviceInfo& device) {
    return {{"name", device.name},
            {"driver", device.driver},
            {"type", taskpool::gpu::to_string(device.type)},
            {"subgroup_size", device.subgroup_size},
            {"memory_bytes", device.memory_bytes},
            {"persistent_workgroups", device.persistent_workgroups}};
}

/// Path and hash of every file that the experiment reads.
nlohmann::json input_hashes(const config::Config& config) {
    nlohmann::json inputs = nlohmann::json::object();
    for (const config::Scene& scene : config.scenes)
        for (const fs::path& file : {scene.file, scene.views})
            if (!file.empty() && !inputs.contains(file.string()))
                inputs[file.string()] = sha256_of_file(file);
    return inputs;
}

/// Creates the folders and checks that files can be made in them.
void make_writable(const fs::path& path) {
    std::error_code code;
    fs::create_directories(path / "images", code);
    if (!code && ::access(path.c_str(), W_OK | X_OK) != 0) code = {errno, std::generic_category()};
    if (code)
        throw ConfigError(fmt::format("--out {}: cannot be written: {}; choose another folder",
                                      path.string(), code.message()));
}

/// Why the run of `old` cannot be continued as `fresh`, or nothing.
std::string difference(const nlohmann::json& old, const nlohmann::json& fresh) {
    if (old.at("config_sha256") != fresh.at("config_sha256"))
        return "it was made with another config; use the same one, or a new --out";
    if (old.at("inputs") != fresh.at("inputs"))
        return "its input files have changed; start a new run";
    if (old.at("device") != fresh.at("device"))
        return fmt::format(
            "it was made on '{}', this is '{}'; choose that with --device, or a new "
            "--out",
            old.at("device").value("name", "?") + ", " + old.at("device").value("driver", "?"),
            fresh.at("device").value("name", "?") + ", " + fresh.at("device").value("driver", "?"));
    return {};
}

}  // namespace

void write_text(const fs::path& path, const std::string& text) {
    const fs::path temporary = path.string() + ".part";
    try {
        image::write_file(temporary, text);
        fs::rename(temporary, path);
    } catch (const std::exception& error) {
        throw OutputError(error.what() + std::string("; make room, then go on with --resume"));
    }
}

nlohmann::json read_json(const fs::path& path) {
    std::ifstream stream(path);
    if (!stream)
        throw std::runtime_error(path.string() +
                                 ": cannot be opened; expected the folder of a run");
    try {
        return nlohmann::json::parse(stream);
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error(path.string() + ": is no valid JSON: " + error.what());
    }
}

std::string file_name(const std::string& label) {
    std::string name = label.substr(0, 80);
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    return name == label ? name : name + "-" + sha256(label).substr(0, 6);
}

fs::path fresh_folder(const std::string& name) {
    const std::string stamp =
        fmt::format("{}-{:%Y%m%dT%H%M%SZ}", name, fmt::gmtime(std::time(nullptr)));
    fs::path path = fs::absolute("runs") / stamp;
    for (int i = 2; fs::exists(path); ++i)
        path = fs::absolute("runs") / fmt::format("{}-{}", stamp, i);
    return path;
}

RunFolder open_run(const fs::path& path, bool resume, const config::Config& config,
                   const taskpool::gpu::DeviceInfo& device, const std::string& command_line) {
    nlohmann::json fresh = {{"schema", 1},
                            {"config_file", fs::absolute(config.file).string()},
                            {"config", config::to_json(config)},
                            {"config_sha256", sha256(config::to_json(config).dump())},
                            {"inputs", input_hashes(config)},
                            {"device", to_json(device)},
                            {"host", host_provenance()},
                            {"program", program_provenance()},
                            {"sessions", nlohmann::json::array()}};
    RunFolder folder{path, fresh};
    const fs::path manifest = path / "manifest.json";
    if (fs::exists(manifest)) {
        if (!resume)
            throw ConfigError(
                fmt::format("--out {}: holds a run already; continue it with --resume, "
                            "or choose another folder",
                            path.string()));
        folder.manifest = read_json(manifest);
        const std::string why = difference(folder.manifest, fresh);
        if (!why.empty())
            throw ConfigError(
                fmt::format("--resume {}: cannot be continued: {}", path.string(), why));
    } else if (fs::exists(path) && !fs::is_directory(path)) {
        throw ConfigError(fmt::format("--out {}: is no folder; choose another", path.string()));
    }
    make_writable(path);
    folder.manifest["sessions"].push_back({{"start", utc_now()},
                                           {"end", nullptr},
                                           {"command_line", command_line},
                                           {"git_commit", fresh["program"]["git_commit"]},
                                           {"git_dirty", fresh["program"]["git_dirty"]},
                                           {"exit", nullptr}});
    write_text(manifest, folder.manifest.dump(2) + "\n");
    return folder;
}

void close_run(RunFolder& folder, int exit_code, const std::vector<std::string>& failures) {
    nlohmann::json& session = folder.manifest["sessions"].back();
    session["end"] = utc_now();
    session["exit"] = exit_code;
    session["failures"] = failures;
    write_text(folder.path / "manifest.json", folder.manifest.dump(2) + "\n");
}

void write_summary(const RunFolder& folder, std::span<const ResultSummary> results) {
    write_text(folder.path / "summary.json", measure::to_json(results).dump(1) + "\n");
}

}  // namespace experiments::measure
