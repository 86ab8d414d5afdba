// grove run
#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "experiments/commands/experiment.hpp"
#include "experiments/commands/program.hpp"
#include "experiments/measure/stability_matrix.hpp"

namespace experiments::commands {
namespace {

constexpr const char* kColumns[] = {"build_ms",  "query_ms",       "total_ms",
                                    "sah_cost",  "shadowed",       "differing_points",
                                    "false_lit", "false_shadowed", "memory_bytes"};

/// SPIR-V from `folder`/<shader path>.spv, as the build leaves it in its `shaders` folder.
std::optional<std::vector<std::uint32_t>> read_shader(const std::filesystem::path& folder,
                                                      std::string_view path) {
    std::ifstream stream(folder / (std::string(path) + ".spv"), std::ios::binary);
    if (!stream) return {};
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::copy_n(bytes.begin(), words.size() * 4, reinterpret_cast<char*>(words.data()));
    return words;
}

taskpool::gpu::DeviceOptions device_options(const RunRequest& request) {
    taskpool::gpu::DeviceOptions options;
    options.index = request.device;
    if (request.shaders.empty()) return options;
    if (!std::filesystem::is_directory(request.shaders))
        throw config::ConfigError("--shaders " + request.shaders + ": is no folder");
    options.shader_source = [folder = request.shaders](std::string_view path) {
        return read_shader(folder, path);
    };
    return options;
}

void check_device_index(int index) {
    const int count = int(taskpool::gpu::list_devices().size());
    if (count > 0 && index >= count)
        throw config::ConfigError(
            fmt::format("--device {}: expected 0 to {}; see grove list devices", index, count - 1));
}

std::string results_table(const config::Config& config,
                          const std::vector<measure::ResultSummary>& results) {
    if (config.stability) return text_table(measure::text_rows(measure::make_matrix(results)), 100);
    std::vector<std::vector<std::string>> rows{{"scene", "method", "variant"}};
    std::vector<const char*> columns;
    for (const char* name : kColumns)
        for (const measure::ResultSummary& result : results)
            if (result.find(name) && (columns.empty() || columns.back() != name))
                columns.push_back(name);
    rows[0].insert(rows[0].end(), columns.begin(), columns.end());
    for (const measure::ResultSummary& result : results) {
        if (result.method == measure::kSceneRows) continue;
        auto& row = rows.emplace_back(
            std::vector<std::string>{result.scene, result.method, result.variant});
        for (const char* name : columns) {
            const measure::MetricSummary* metric = result.find(name);
            row.push_back(metric ? measure::readable(metric->statistics.median, metric->unit)
                                 : "-");
        }
    }
    return text_table(rows, 3);
}

std::filesystem::path folder_of(const RunRequest& request, const config::Config& config) {
    const std::filesystem::path out = request.out;
    return request.out.empty() || request.configs.size() == 1 ? out : out / config.name;
}

}  // namespace

int run(const RunRequest& request, const measure::Registries& registries) {
    if (request.resume && request.out.empty())
        throw config::ConfigError("--resume needs --out, the folder of the run to continue");
    const config::Catalogue catalogue =
        config::make_catalogue(registries.structures, registries.methods);
    std::vector<config::Config> configs;
    for (const std::string& file : request.configs)
        configs.push_back(config::load(file, request.assignments, catalogue));

    const taskpool::gpu::DeviceOptions options = device_options(request);
    if (request.device >= 0) check_device_index(request.device);
    std::unique_ptr<taskpool::gpu::Device> device;
    try {
        device = std::make_unique<taskpool::gpu::Device>(options);
    } catch (const taskpool::gpu::Error& error) {
        throw std::runtime_error(
            fmt::format("no Vulkan device to run on: {}; see grove doctor", error.what()));
    }
    std::filesystem::path cache = request.cache;
    if (cache.empty()) cache = measure::default_cache_folder();
    int code = 0;
    for (const config::Config& config : configs) {
        measure::Progress progress(request.quiet ? measure::Progress::Mode::quiet
                                                 : measure::Progress::Mode::automatic);
        const RunOutcome outcome = run_experiment(
            *device, config, registries,
            {folder_of(request, config), request.resume, request.command_line, cache}, progress);
        if (!outcome.failures.empty()) code = 1;
        if (!request.quiet) fmt::print("{}\n", results_table(config, outcome.results));
        fmt::print("{}\n", outcome.folder.string());
        std::fflush(stdout);
    }
    return code;
}

}  // namespace experiments::commands
