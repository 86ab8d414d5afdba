#include "experiments/config/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments::config {
namespace {

bool sweeps(const std::string& key, const Node& value, std::string_view list_key) {
    if (value.kind != Node::Kind::array) return false;
    if (key != list_key) return true;
    return !value.items.empty() && value.items.front().kind == Node::Kind::array;
}

std::string text_of(const Node& value) {
    if (value.kind == Node::Kind::scalar) return structures::to_string(value.scalar);
    std::vector<std::string> parts;
    for (const Node& item : value.items) parts.push_back(text_of(item));
    return fmt::format("{}", fmt::join(parts, "x"));
}

}  // namespace

std::vector<Combination> expand(const Node& table, std::string_view list_key) {
    std::vector<Combination> combinations{{table, {}}};
    for (std::size_t k = 0; k < table.keys.size(); ++k) {
        const Node& list = table.items[k];
        if (!sweeps(table.keys[k], list, list_key)) continue;
        if (list.items.empty())
            fail(list,
                 fmt::format("'{}' is an empty list; expected at least one value", table.keys[k]));
        std::vector<Combination> longer;
        for (const Combination& combination : combinations) {
            for (const Node& item : list.items) {
                Combination next = combination;
                next.table.items[k] = item;
                next.swept.push_back(table.keys[k]);
                longer.push_back(std::move(next));
            }
        }
        combinations = std::move(longer);
        if (combinations.size() > 10000)
            fail(list, "the lists of this table combine to more than 10000 runs; shorten them");
    }
    return combinations;
}

std::string sweep_label(const Combination& combination, const std::vector<std::string>& except) {
    std::vector<std::string> parts;
    for (const std::string& key : combination.swept)
        if (std::find(except.begin(), except.end(), key) == except.end())
            parts.push_back(key + "=" + text_of(*combination.table.find(key)));
    return fmt::format("{}", fmt::join(parts, ","));
}

}  // namespace experiments::config
