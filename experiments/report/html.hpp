// Small pieces of HTML, and the style sheet of all pages and drawings.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace experiments::report {

/// `text` with the characters that mean something in HTML replaced.
std::string escape(std::string_view text);

/// `text` cut to `longest` bytes, at the end of a UTF-8 character, with an ellipsis for the rest.
std::string shortened(const std::string& text, std::size_t longest);

/// "data:image/png;base64,..." of a file. Throws std::runtime_error if it cannot be read.
std::string png_data_uri(const std::filesystem::path& file);

/// The inline drawing `svg` as a file of its own: with the page's style sheet and a background.
std::string standalone_svg(const std::string& svg);

/// Opening of a document up to and with <body>: style sheet for light and dark, small and large.
std::string document_head(const std::string& title);

}  // namespace experiments::report
