#include "experiments/commands/experiment.hpp"

#include "experiments/measure/accuracy.hpp"
#include "experiments/measure/stability_matrix.hpp"
#include "experiments/report/report.hpp"

namespace experiments::commands {

using namespace measure;

RunOutcome run_experiment(taskpool::gpu::Device& device, const config::Config& config,
                          const Registries& registries, const RunOptions& options,
                          Progress& progress) {
    const std::filesystem::path path =
        options.out.empty() ? fresh_folder(config.name)
                            : std::filesystem::absolute(options.out).lexically_normal();
    RunFolder folder = open_run(path, options.resume, config, device.info(), options.command_line);
    progress.log_to(path / "log.txt");
    RunOutcome outcome{path, {}, {}};
    try {
        SamplesFile samples(folder.samples());
        TruthCache cache(options.cache, [&](const std::string& line) { progress.note(line); });
        Session session{device, config, registries, folder, samples, progress, cache};
        config.kind == "stability" ? run_stability(session)
        : config.kind == "build"   ? run_builds(session)
                                   : run_shadows(session);
        // From the file: it also holds what earlier sessions of a resumed run have found.
        const std::vector<Row> rows = read_samples(folder.samples());
        outcome.results = summarise(rows);
        for (const std::string& line : config.stability ? broken_stability_claims(outcome.results)
                                                        : broken_claims(outcome.results))
            session.fail(line);
        outcome.failures = session.failures;
        write_summary(folder, outcome.results);
        close_run(folder, outcome.failures.empty() ? 0 : 1, outcome.failures);
        report::write_report(path, rows, outcome.results);
    } catch (const std::exception& error) {
        progress.log_error(error.what());
        // The manifest says how the run ended if the disk still takes it; the first error counts.
        try {
            outcome.failures.push_back(error.what());
            close_run(folder, 1, outcome.failures);
        } catch (const OutputError&) {
        }
        throw;
    }
    progress.clear();
    return outcome;
}

}  // namespace experiments::commands
