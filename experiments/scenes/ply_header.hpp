// The header of a PLY file: which elements follow, with which properties.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace experiments::scenes::ply {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
/// Bytes of each type in a binary body.
inline constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> count_type{};  ///< set for a list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties{};
};

struct Header {
    std::string format;
    std::vector<Element> elements;
    std::size_t size = 0;  ///< bytes up to the body
};

/// Reads the header at the start of `bytes`. Its lines end as the first one does ("\n", "\r\n" or
/// "\r"), so that the body starts exactly behind end_header even if its first byte happens to be a
/// line end. Throws FormatError naming the line.
Header parse_header(std::string_view bytes);

}  // namespace experiments::scenes::ply
