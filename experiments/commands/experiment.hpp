// Runs one experiment from its config to the finished folder.
#pragma once

#include "experiments/measure/session.hpp"
#include "experiments/measure/summary.hpp"

namespace experiments::commands {

struct RunOptions {
    std::filesystem::path out{};  ///< empty: a fresh folder below runs/
    bool resume = false;
    std::string command_line{};
    std::filesystem::path cache{};  ///< folder of what is worth keeping between runs; empty: none
};

struct RunOutcome {
    std::filesystem::path folder;
    std::vector<measure::ResultSummary> results;
    std::vector<std::string> failures;  ///< empty: all went well
};

/// Throws ConfigError before any work, OutputError or gpu::Error when the run cannot go on; what
/// was measured until then is in the folder.
RunOutcome run_experiment(taskpool::gpu::Device& device, const config::Config& config,
                          const measure::Registries& registries, const RunOptions& options,
                          measure::Progress& progress);

}  // namespace experiments::commands
