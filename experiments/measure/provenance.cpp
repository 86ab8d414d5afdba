#include "experiments/measure/provenance.hpp"

#include <fmt/chrono.h>
#include <sched.h>
#include <sys/sysinfo.h>
#include <sys/utsname.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>

#include "experiments/build_info.hpp"

namespace experiments::measure {
namespace {

/// Standard output of `git -C <source> arguments`, without the last line break; nothing if it
/// fails.
std::optional<std::string> git(const std::string& arguments) {
    std::string folder;  // in single quotes, as the shell wants it
    for (char c : source_folder()) folder += c == '\'' ? "'\\''" : std::string(1, c);
    const std::string command = "git -C '" + folder + "' " + arguments + " 2>/dev/null";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (!pipe) return {};
    std::string output;
    char block[4096];
    for (std::size_t n; (n = std::fread(block, 1, sizeof block, pipe)) > 0;)
        output.append(block, n);
    if (::pclose(pipe) != 0) return {};
    while (!output.empty() && output.back() == '\n') output.pop_back();
    return output;
}

std::string cpu_model() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

int usable_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    return ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : get_nprocs();
}

}  // namespace

std::string source_folder() { return kSourceFolder; }

std::string utc_now() {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

nlohmann::json program_provenance() {
    nlohmann::json json = {{"version", kVersion},
                           {"compiler", kCompiler},
                           {"flags", kFlags},
                           {"build_type", kBuildType}};
    const auto commit = git("rev-parse HEAD");
    const auto status = commit ? git("status --porcelain --untracked-files=no") : std::nullopt;
    json["git_commit"] = commit.value_or(kConfiguredCommit);
    json["git_dirty"] = status ? nlohmann::json(!status->empty()) : nlohmann::json(nullptr);
    return json;
}

nlohmann::json host_provenance() {
    utsname system{};
    ::uname(&system);
    struct sysinfo memory {};
    ::sysinfo(&memory);
    return {{"cpu", cpu_model()},
            {"cores", usable_cores()},
            {"memory_bytes", std::uint64_t(memory.totalram) * memory.mem_unit},
            {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)}};
}

}  // namespace experiments::measure
