// Decimal numbers, rounded once.
#include <charconv>
#include <cstdlib>
#include <string>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {

const char* parse_float(const char* text, const char* end, float& value) {
    if (text != end && *text == '+') ++text;  // from_chars takes no plus
    const auto [next, code] = std::from_chars(text, end, value);
    if (code == std::errc()) return next;
    if (code != std::errc::result_out_of_range) return nullptr;
    value = std::strtof(std::string(text, next).c_str(), nullptr);  // infinity or a tiny number
    return next;
}

}  // namespace experiments::scenes
