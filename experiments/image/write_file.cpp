// Whole files onto the disk, every step checked.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "experiments/image/image.hpp"

namespace experiments::image {

void write_file(const std::filesystem::path& path, std::span<const char> bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) throw FileError(path, fmt::format("cannot be created: {}", std::strerror(errno)));
    // A full disk may show up only when buffers are flushed or the file is closed.
    const bool written =
        std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
    int reason = written ? 0 : errno;
    if (std::fclose(file) != 0 && written) reason = errno;
    if (reason == 0) return;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
    throw FileError(path, fmt::format("cannot be written: {}", std::strerror(reason)));
}

}  // namespace experiments::image
