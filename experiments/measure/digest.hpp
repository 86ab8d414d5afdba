// SHA-256, as 64 hexadecimal digits.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace experiments::measure {

std::string sha256(std::string_view bytes);
/// Of a file's content. Throws std::runtime_error if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace experiments::measure
