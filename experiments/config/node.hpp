// A TOML document as a small tree whose every value knows where it was written, so that a message
// can name the file and the line after --set and sweeps have rearranged it.
//
//     Node root = parse_file("quickstart.toml");
//     override_value(root, "method.0.stack=16");
//     const Node* name = root.find("experiment")->find("name");
//     fail(*name, "expected a string");          // "quickstart.toml:3: expected a string"
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "structures/parameters.hpp"

namespace experiments::config {

/// The command line or a config is at fault: exit code 2. what() is one line.
struct ConfigError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Node {
    enum class Kind { scalar, array, table };
    Kind kind = Kind::table;
    structures::Value scalar{};     ///< of a scalar
    std::vector<Node> items;        ///< of an array, or a table's values
    std::vector<std::string> keys;  ///< of a table, parallel to `items`
    std::string place;              ///< "file.toml:12" or "--set method.0.stack"
    std::filesystem::path folder;   ///< what relative paths written here start from

    /// The value of `key` in a table, or nullptr.
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
    /// The value of `key` in a table, added (as an empty table placed like this one) if missing.
    Node& at_or_add(std::string_view key);
};

/// "an integer", "a list", ...: what `node` is, in words.
std::string describe(const Node& node);

[[noreturn]] void fail(const Node& node, const std::string& message);

/// Throws ConfigError if the file cannot be read or is no valid TOML.
Node parse_file(const std::filesystem::path& file);
/// The same for text; `name` stands for the file in messages.
Node parse_text(std::string_view text, const std::string& name,
                const std::filesystem::path& folder);

/// Applies one `--set KEY=VALUE`. KEY is dotted, numbers index lists (one past the end appends).
/// VALUE is TOML; what TOML does not accept is taken as a string. Relative paths in it start from
/// the working directory.
void override_value(Node& root, const std::string& assignment);

}  // namespace experiments::config
