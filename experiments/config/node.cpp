#include "experiments/config/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

// The parser checks its own expectations with TOML_ASSERT; malformed input can violate them, so
// they must throw. With NDEBUG the library would turn them into undefined behaviour instead. (Some
// of its functions are noexcept; those expectations do not depend on the input.)
#pragma GCC diagnostic ignored "-Wterminate"
#undef NDEBUG
#define TOML_ASSERT(expression) \
    ((expression) ? void() : throw std::logic_error("not understood: " #expression))
#include <toml++/toml.h>

namespace experiments::config {
namespace {

Node scalar_node(structures::Value value) {
    Node node;
    node.kind = Node::Kind::scalar;
    node.scalar = std::move(value);
    return node;
}

Node convert(const toml::node& source, const std::string& name,
             const std::filesystem::path& folder) {
    const std::string place = fmt::format("{}:{}", name, source.source().begin.line);
    Node node;
    if (const toml::table* table = source.as_table()) {
        for (const auto& [key, value] : *table) {
            node.keys.emplace_back(key.str());
            node.items.push_back(convert(value, name, folder));
        }
    } else if (const toml::array* array = source.as_array()) {
        node.kind = Node::Kind::array;
        for (const toml::node& item : *array) node.items.push_back(convert(item, name, folder));
    } else if (const auto boolean = source.value_exact<bool>()) {
        node = scalar_node(*boolean);
    } else if (const auto integer = source.value_exact<std::int64_t>()) {
        node = scalar_node(*integer);
    } else if (const auto real = source.value_exact<double>()) {
        node = scalar_node(*real);
    } else if (const auto text = source.value_exact<std::string>()) {
        node = scalar_node(*text);
    } else {
        throw ConfigError(place + ": dates and times have no meaning here; write a string");
    }
    node.place = place;
    node.folder = folder;
    return node;
}

/// Every place below `node` becomes `place`.
void place_all(Node& node, const std::string& place, const std::filesystem::path& folder) {
    node.place = place;
    node.folder = folder;
    for (Node& item : node.items) place_all(item, place, folder);
}

Node parse_value(const std::string& text, const std::string& place) {
    const std::filesystem::path folder = std::filesystem::current_path();
    Node value = scalar_node(text);
    try {
        Node document = parse_text("value = " + text + "\n", place, folder);
        // More than one key: the text had a line break and was no single value.
        if (document.items.size() == 1) value = document.items.front();
    } catch (const ConfigError&) {
        // A bare word, such as a path: a string.
    }
    place_all(value, place, folder);
    return value;
}

bool is_number(std::string_view text) {
    return !text.empty() && text.size() < 6 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The element of list `node` that `part` indexes; the one past the end is added.
Node& element(Node& node, const std::string& part, const std::string& place) {
    if (!is_number(part))
        throw ConfigError(fmt::format("{}: '{}' is no index into a list; expected 0 to {}", place,
                                      part, node.items.size()));
    const std::size_t index = std::stoul(part);
    if (index > node.items.size())
        throw ConfigError(fmt::format("{}: the list has {} entries; expected an index from 0 to {}",
                                      place, node.items.size(), node.items.size()));
    if (index == node.items.size()) {
        node.items.emplace_back();
        node.items.back().place = place;
    }
    return node.items[index];
}

}  // namespace

const Node* Node::find(std::string_view key) const {
    const auto it = std::find(keys.begin(), keys.end(), key);
    return it == keys.end() ? nullptr : &items[it - keys.begin()];
}

Node* Node::find(std::string_view key) {
    return const_cast<Node*>(static_cast<const Node*>(this)->find(key));
}

Node& Node::at_or_add(std::string_view key) {
    if (Node* found = find(key)) return *found;
    Node added;
    added.place = place;
    added.folder = folder;
    keys.emplace_back(key);
    items.push_back(std::move(added));
    return items.back();
}

std::string describe(const Node& node) {
    static constexpr const char* kScalars[] = {"a boolean", "an integer", "a number", "a string"};
    if (node.kind == Node::Kind::array) return "a list";
    return node.kind == Node::Kind::table ? "a table" : kScalars[node.scalar.index()];
}

void fail(const Node& node, const std::string& message) {
    throw ConfigError(node.place + ": " + message);
}

Node parse_text(std::string_view text, const std::string& name,
                const std::filesystem::path& folder) {
    try {
        return convert(toml::parse(text), name, folder);
    } catch (const toml::parse_error& error) {
        throw ConfigError(
            fmt::format("{}:{}: {}", name, error.source().begin.line, error.description()));
    } catch (const std::logic_error& error) {
        throw ConfigError(fmt::format("{}: malformed TOML ({})", name, error.what()));
    }
}

Node parse_file(const std::filesystem::path& file) {
    std::error_code code;
    if (std::filesystem::is_directory(file, code))
        throw ConfigError(file.string() + ": is a folder; expected a config file (.toml)");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw ConfigError(
            file.string() +
            ": cannot be opened; check the path (configs lie in experiments/configs)");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_text(text, file.string(), std::filesystem::absolute(file).parent_path());
}

void override_value(Node& root, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const std::string path = assignment.substr(0, equals);
    const std::string place = "--set " + path;
    if (equals == std::string::npos || equals == 0)
        throw ConfigError(
            fmt::format("--set {}: expected KEY=VALUE, e.g. --set method.0.stack=16", assignment));
    Node* node = &root;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string part = path.substr(begin, end - begin);
        if (part.empty()) throw ConfigError(place + ": a part between two dots is empty");
        if (node->kind == Node::Kind::scalar) *node = Node{.place = place};
        // A new list starts where a number follows a key that did not exist.
        if (node->kind == Node::Kind::table && node->keys.empty() && is_number(part))
            node->kind = Node::Kind::array;
        node =
            node->kind == Node::Kind::array ? &element(*node, part, place) : &node->at_or_add(part);
        begin = end + 1;
    }
    *node = parse_value(assignment.substr(equals + 1), place);
}

}  // namespace experiments::config
