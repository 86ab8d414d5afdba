// Reads the keys of one config table and reports every key it was not asked for.
//
//     Table table(node, "[experiment]");
//     const std::int64_t repeat = table.integer("repeat", 1, 10000).value_or(5);
//     table.finish();            // "x.toml:4: unknown key 'repat' in [experiment]; did you mean
//     ..."
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/node.hpp"

namespace experiments::config {

class Table {
  public:
    /// `title` names the table in messages. Fails unless `node` is a table.
    Table(const Node& node, std::string title);

    /// The value of `key`, or nullptr; the key counts as known from now on.
    const Node* find(const std::string& key);
    std::optional<std::string> text(const std::string& key);
    /// One of `choices`.
    std::optional<std::string> choice(const std::string& key,
                                      std::initializer_list<const char*> choices);
    std::optional<bool> boolean(const std::string& key);
    std::optional<std::int64_t> integer(const std::string& key, std::int64_t minimum,
                                        std::int64_t maximum);
    std::optional<double> real(const std::string& key);
    std::optional<glm::vec3> vector(const std::string& key);
    /// A path, made absolute from the folder it was written in; "$NAME/rest" starts from the folder
    /// that the environment variable NAME holds.
    std::optional<std::filesystem::path> path(const std::string& key);
    /// Fails naming `key` unless `value` holds something.
    template <typename T>
    T required(const std::string& key, std::optional<T> value) const {
        if (!value) fail(node_, title_ + " lacks the key '" + key + "'");
        return *value;
    }

    /// Keys nobody has asked for.
    std::vector<std::string> unread() const;
    void finish() const;

    const Node& node() const { return node_; }
    const std::string& title() const { return title_; }

  private:
    const Node& node_;
    std::string title_;
    std::vector<std::string> known_;
};

/// The error message for `word`, which is none of `known`: with the closest of them, or all.
std::string unknown(const std::string& what, const std::string& word,
                    const std::vector<std::string>& known);

}  // namespace experiments::config
