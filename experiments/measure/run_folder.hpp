// The folder of one run: samples.csv, summary.json, manifest.json, images/, log.txt, report.html.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "experiments/config/config.hpp"
#include "experiments/measure/summary.hpp"
#include "taskpool/gpu/device_list.hpp"

namespace experiments::measure {

struct RunFolder {
    std::filesystem::path path;
    nlohmann::json manifest;

    std::filesystem::path samples() const { return path / "samples.csv"; }
    std::filesystem::path images() const { return path / "images"; }
    std::filesystem::path traces() const { return path / "traces"; }
};

/// Writes the whole file, or leaves the old one. Throws OutputError.
void write_text(const std::filesystem::path& path, const std::string& text);
/// Throws std::runtime_error naming the file if it cannot be read or is no JSON.
nlohmann::json read_json(const std::filesystem::path& path);

/// A file name from any label: other characters become '_', and a long or changed name is told
/// apart by the start of its hash.
std::string file_name(const std::string& label);

/// runs/<name>-<UTC time> below the working directory, not taken yet.
std::filesystem::path fresh_folder(const std::string& name);

/// Throws ConfigError if `path` can take no run: not writable, or it holds one and `resume` is
/// false, or resuming one of another config, of other input files or on another device.
RunFolder open_run(const std::filesystem::path& path, bool resume, const config::Config& config,
                   const taskpool::gpu::DeviceInfo& device, const std::string& command_line);

/// Records the end of this session in the manifest and writes it.
void close_run(RunFolder& folder, int exit_code, const std::vector<std::string>& failures);

/// Writes summary.json.
void write_summary(const RunFolder& folder, std::span<const ResultSummary> results);

}  // namespace experiments::measure
