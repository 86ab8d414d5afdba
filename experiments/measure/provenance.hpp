// Where a run's numbers come from: program, source, host.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace experiments::measure {

/// Compiler, flags, build type; git commit and whether the tree is dirty, asked now where the
/// source folder still is, as they were at configuration otherwise.
nlohmann::json program_provenance();

/// CPU model, cores this process may use, memory, operating system.
nlohmann::json host_provenance();

/// Root of the source tree the program was built from.
std::string source_folder();

/// "2026-11-23T05:13:01Z".
std::string utc_now();

}  // namespace experiments::measure
