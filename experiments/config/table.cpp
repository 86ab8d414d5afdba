#include "experiments/config/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace experiments::config {
namespace {

[[noreturn]] void wrong_type(const Node& node, const std::string& key,
                             const std::string& expected) {
    fail(node, fmt::format("'{}' is {}; expected {}", key, describe(node), expected));
}

std::optional<double> as_real(const Node& node) {
    if (node.kind != Node::Kind::scalar) return {};
    if (const auto* real = std::get_if<double>(&node.scalar)) return *real;
    if (const auto* integer = std::get_if<std::int64_t>(&node.scalar)) return double(*integer);
    return {};
}

}  // namespace

std::string unknown(const std::string& what, const std::string& word,
                    const std::vector<std::string>& known) {
    const std::string near = structures::closest(word, known);
    return near.empty()
               ? fmt::format("unknown {} '{}'; known: {}", what, word, fmt::join(known, ", "))
               : fmt::format("unknown {} '{}'; did you mean '{}'?", what, word, near);
}

Table::Table(const Node& node, std::string title) : node_(node), title_(std::move(title)) {
    if (node.kind != Node::Kind::table) wrong_type(node, title_, "a table");
}

const Node* Table::find(const std::string& key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
    return node_.find(key);
}

std::optional<std::string> Table::text(const std::string& key) {
    const Node* node = find(key);
    if (!node) return {};
    const auto* text = std::get_if<std::string>(&node->scalar);
    if (node->kind != Node::Kind::scalar || !text) wrong_type(*node, key, "a string");
    return *text;
}

std::optional<std::string> Table::choice(const std::string& key,
                                         std::initializer_list<const char*> choices) {
    auto value = text(key);
    const std::vector<std::string> names(choices.begin(), choices.end());
    if (value && std::find(names.begin(), names.end(), *value) == names.end())
        fail(*node_.find(key), unknown(key, *value, names));
    return value;
}

std::optional<bool> Table::boolean(const std::string& key) {
    const Node* node = find(key);
    if (!node) return {};
    const auto* value = std::get_if<bool>(&node->scalar);
    if (node->kind != Node::Kind::scalar || !value) wrong_type(*node, key, "true or false");
    return *value;
}

std::optional<std::int64_t> Table::integer(const std::string& key, std::int64_t minimum,
                                           std::int64_t maximum) {
    const Node* node = find(key);
    if (!node) return {};
    const auto* value = std::get_if<std::int64_t>(&node->scalar);
    if (node->kind != Node::Kind::scalar || !value)
        wrong_type(*node, key, fmt::format("an integer from {} to {}", minimum, maximum));
    if (*value < minimum || *value > maximum)
        fail(*node, fmt::format("'{}' is {}; expected an integer from {} to {}", key, *value,
                                minimum, maximum));
    return *value;
}

std::optional<double> Table::real(const std::string& key) {
    const Node* node = find(key);
    if (!node) return {};
    const auto value = as_real(*node);
    if (!value) wrong_type(*node, key, "a number");
    if (!std::isfinite(*value))
        fail(*node, fmt::format("'{}' is {}; expected a finite number", key, *value));
    return value;
}

std::optional<glm::vec3> Table::vector(const std::string& key) {
    const Node* node = find(key);
    if (!node) return {};
    if (node->kind != Node::Kind::array || node->items.size() != 3)
        wrong_type(*node, key, "three numbers, [x, y, z]");
    glm::vec3 value(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto real = as_real(node->items[axis]);
        if (!real || !std::isfinite(float(*real)))
            fail(node->items[axis], fmt::format("'{}' has an entry that is no finite number", key));
        value[axis] = float(*real);
    }
    return value;
}

std::optional<std::filesystem::path> Table::path(const std::string& key) {
    const std::optional<std::string> value = text(key);
    if (!value) return std::nullopt;
    if (value->empty()) fail(*node_.find(key), fmt::format("'{}' is empty; expected a path", key));
    if ((*value)[0] != '$') return node_.find(key)->folder / *value;
    // "$NAME/rest": where a collection of scenes lies differs between machines.
    const std::size_t slash = std::min(value->find('/'), value->size());
    const std::string name = value->substr(1, slash - 1);
    const char* folder = std::getenv(name.c_str());
    if (!folder)
        fail(*node_.find(key), fmt::format("'{}' is {}, but the environment variable {} is not set",
                                           key, *value, name));
    return std::filesystem::absolute(folder + value->substr(slash));
}

std::vector<std::string> Table::unread() const {
    std::vector<std::string> keys;
    for (const std::string& key : node_.keys)
        if (std::find(known_.begin(), known_.end(), key) == known_.end()) keys.push_back(key);
    return keys;
}

void Table::finish() const {
    for (const std::string& key : unread())
        fail(*node_.find(key), unknown("key", key, known_) + " (in " + title_ + ")");
}

}  // namespace experiments::config
