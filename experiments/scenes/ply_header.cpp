// The header of a PLY file, line by line.
#include "experiments/scenes/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes::ply {
namespace {

constexpr std::array<std::array<std::string_view, 2>, 8> kTypeNames = {{{"char", "int8"},
                                                                        {"uchar", "uint8"},
                                                                        {"short", "int16"},
                                                                        {"ushort", "uint16"},
                                                                        {"int", "int32"},
                                                                        {"uint", "uint32"},
                                                                        {"float", "float32"},
                                                                        {"double", "float64"}}};

std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != line.npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
        words.emplace_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

Type type_named(const std::string& word, int line) {
    for (std::size_t i = 0; i < kTypeNames.size(); ++i)
        if (word == kTypeNames[i][0] || word == kTypeNames[i][1]) return static_cast<Type>(i);
    throw FormatError(fmt::format("PLY header line {}: unknown type '{}'", line, word));
}

Property parse_property(const std::vector<std::string>& words, int line) {
    if (words.size() == 3) return {words[2], type_named(words[1], line), {}};
    if (words.size() == 5 && words[1] == "list")
        return {words[4], type_named(words[3], line), type_named(words[2], line)};
    throw FormatError(fmt::format("PLY header line {}: malformed property", line));
}

}  // namespace

Header parse_header(std::string_view bytes) {
    const std::size_t first_end = bytes.substr(0, 5).find_first_of("\r\n");
    if (bytes.substr(0, 3) != "ply" || first_end != 3)
        throw FormatError("is not a PLY file: its first line is not 'ply'");
    const std::string_view line_end = bytes.substr(3, 2) == "\r\n" ? "\r\n" : bytes.substr(3, 1);

    Header header;
    std::size_t at = 0;
    for (int line = 1;; ++line) {
        const std::size_t end = bytes.find(line_end, at);
        if (end == bytes.npos)
            throw FormatError(fmt::format("PLY header ends in line {} without end_header", line));
        const std::vector<std::string> words = words_of(bytes.substr(at, end - at));
        at = end + line_end.size();
        const std::string keyword = words.empty() ? "" : words[0];
        if (keyword == "end_header") break;
        if (keyword == "format" && words.size() == 3) {
            header.format = words[1];
        } else if (keyword == "element" && words.size() == 3) {
            Element element{words[1]};
            const std::string& count = words[2];
            const auto [stop, code] =
                std::from_chars(count.data(), count.data() + count.size(), element.count);
            if (code != std::errc() || stop != count.data() + count.size())
                throw FormatError(
                    fmt::format("PLY header line {}: '{}' is no element count", line, count));
            header.elements.push_back(std::move(element));
        } else if (keyword == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(parse_property(words, line));
        } else if (line > 1 && !keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            throw FormatError(
                fmt::format("PLY header line {}: cannot read '{}'", line, keyword.substr(0, 40)));
        }
    }
    header.size = at;
    return header;
}

}  // namespace experiments::scenes::ply
