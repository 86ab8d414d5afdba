// What every loader throws: one line that names the file, the place in it and the remedy.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace experiments::scenes {

/// what() is "PATH: message", one line of printable text: messages quote the files they complain
/// about, which may hold anything.
struct LoadError : std::runtime_error {
    LoadError(const std::filesystem::path& file, const std::string& message)
        : std::runtime_error(file.string() + ": " + printable(message)), path(file) {}
    std::filesystem::path path;

  private:
    static std::string printable(std::string message) {
        constexpr std::size_t kMaxLength = 400;
        if (message.size() > kMaxLength) message.replace(kMaxLength, message.npos, "...");
        for (char& c : message)
            if (c < ' ' || c > '~') c = '?';
        return message;
    }
};

}  // namespace experiments::scenes
