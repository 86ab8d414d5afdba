// The command line of `grove`.
#pragma once

#include <string>
#include <vector>

#include "experiments/measure/session.hpp"

namespace experiments::commands {

/// Runs what `argv` asks for, with these structures and methods. Returns the exit code: 0 done, 1
/// the work failed or a limit was passed, 2 the command line or a config is at fault. Every error
/// is one line on stderr, "grove: error: ...".
int run_program(int argc, const char* const* argv, const measure::Registries& registries);

struct RunRequest {
    std::vector<std::string> configs;
    std::vector<std::string> assignments;  ///< of --set
    std::string out;                       ///< empty: below runs/
    std::string cache;                     ///< folder; empty: the user's own
    std::string shaders;                   ///< folder of SPIR-V to use instead of the embedded
    int device = -1;
    bool resume = false;
    bool quiet = false;
    std::string command_line;
};
/// The commands; each returns its exit code.
int run(const RunRequest& request, const measure::Registries& registries);
int list(const std::string& what, bool as_json, const measure::Registries& registries);
int doctor(const measure::Registries& registries);
/// `limit_percent` below 0: none.
int compare(const std::string& run_a, const std::string& run_b, double limit_percent);

/// A text table with the columns aligned, the first `left_columns` to the left.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t left_columns);

}  // namespace experiments::commands
