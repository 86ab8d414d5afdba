#include "experiments/commands/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>

#include "experiments/config/table.hpp"
#include "experiments/report/report.hpp"

namespace experiments::commands {
namespace {

int fail(std::string message, int code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    fmt::print(stderr, "grove: error: {}\n", message);
    return code;
}

std::string joined(int argc, const char* const* argv) {
    return fmt::format("grove {}", fmt::join(argv + std::min(argc, 1), argv + argc, " "));
}

/// CLI11's own check names the bounds of double in its message.
const CLI::Validator kNotNegative(
    [](const std::string& text) {
        double value = -1;
        return CLI::detail::lexical_cast(text, value) && value >= 0
                   ? std::string()
                   : fmt::format("'{}' is no number from 0 on", text);
    },
    "");

/// What is wrong with a command line whose first word is `command`.
std::string usage_error(const CLI::ParseError& error, const std::string& command) {
    const std::vector<std::string> known = {"run", "test", "list", "doctor", "compare", "report"};
    if (command.empty() || command.front() == '-' ||
        std::count(known.begin(), known.end(), command))
        return fmt::format("{}; see grove --help", error.what());
    return config::unknown("command", command, known);
}

int parse_and_run(int argc, const char* const* argv, const measure::Registries& registries) {
    CLI::App app("Hierarchies built by a GPU task pool, and what they are worth.", "grove");
    app.require_subcommand(1);
    app.footer("`./grove test` builds and runs the tests.");

    RunRequest request;
    request.command_line = joined(argc, argv);
    CLI::App* run_command = app.add_subcommand("run", "run the experiments of config files");
    run_command->add_option("CONFIG", request.configs, "config files (TOML)")->required();
    run_command->add_option("--out", request.out, "folder of the run; default runs/NAME-TIME");
    run_command
        ->add_option("--set", request.assignments, "KEY=VALUE: override, e.g. method.0.stack=16")
        ->allow_extra_args(false);
    run_command->add_option("--device", request.device, "index from `grove list devices`")
        ->check(kNotNegative);
    run_command->add_option("--shaders", request.shaders,
                            "folder of SPIR-V files to use instead of the built-in ones");
    run_command
        ->add_option("--cache", request.cache,
                     "folder that keeps the truth between runs; default ~/.cache/grove")
        ->envname("GROVE_CACHE");
    run_command->add_flag("--resume", request.resume, "continue the run in --out");
    run_command->add_flag("--quiet", request.quiet, "no progress, no table");

    std::string what;
    bool as_json = false;
    CLI::App* list_command = app.add_subcommand("list", "list what there is");
    list_command
        ->add_option("WHAT", what, "structures, shadows, scenes, experiments, devices or metrics")
        ->required();
    list_command->add_flag("--json", as_json, "with all keys, as JSON");

    CLI::App* doctor_command = app.add_subcommand("doctor", "what works here and what is missing");

    std::string run_a, run_b;
    double limit = -1;
    CLI::App* compare_command = app.add_subcommand("compare", "compare two runs, metric by metric");
    compare_command->add_option("RUN_A", run_a, "folder of the run to compare with")->required();
    compare_command->add_option("RUN_B", run_b, "folder of the run to judge")->required();
    compare_command->add_option("--fail-over", limit, "PERCENT: exit 1 if B is worse by more")
        ->check(kNotNegative);

    std::string run_folder;
    CLI::App* report_command = app.add_subcommand("report", "(re)make report.html of a run");
    report_command->add_option("RUN", run_folder, "folder of the run")->required();

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return fail(usage_error(error, argc > 1 ? argv[1] : ""), 2);
    }
    if (*run_command) return run(request, registries);
    if (*list_command) return list(what, as_json, registries);
    if (*doctor_command) return doctor(registries);
    if (*compare_command) return compare(run_a, run_b, limit);
    report::write_report(run_folder);
    fmt::print("{}\n", (std::filesystem::path(run_folder) / "report.html").string());
    return 0;
}

}  // namespace

int run_program(int argc, const char* const* argv, const measure::Registries& registries) {
    // A file size limit then fails the write, which is reported like a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return parse_and_run(argc, argv, registries);
    } catch (const config::ConfigError& error) {
        return fail(error.what(), 2);
    } catch (const std::exception& error) {
        return fail(error.what(), 1);
    }
}

std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       std::size_t left_columns) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) {
            widths.resize(std::max(widths.size(), c + 1));
            widths[c] = std::max(widths[c], row[c].size());
        }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += c < left_columns ? fmt::format("{:<{}}  ", row[c], widths[c])
                                     : fmt::format("{:>{}}  ", row[c], widths[c]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

}  // namespace experiments::commands
