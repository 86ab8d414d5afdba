// What every loader throws: one line that names the file, the place in it and the remedy.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace experiments::scenes {

/// what() is "PATH: message", one line.
struct LoadError : std::runtime_error {
    LoadError(const std::filesystem::path& file, const std::string& message)
        : std::runtime_error(file.string() + ": " + message), path(file) {}
    std::filesystem::path path;
};

}  // namespace experiments::scenes
