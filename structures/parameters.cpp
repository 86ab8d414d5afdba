#include "structures/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace structures {
namespace {

constexpr const char* kTypeNames[] = {"a boolean", "an integer", "a number", "a string"};

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
            diagonal = above;
        }
    }
    return row[b.size()];
}

/// `value` as the type of `parameter`, checked against its choices and range.
Value checked(const Parameter& parameter, Value value) {
    const auto fail = [&](const std::string& expected) {
        return SettingError(parameter.name, fmt::format("'{}' is {}; expected {}", parameter.name,
                                                        to_string(value), expected));
    };
    if (std::holds_alternative<double>(parameter.fallback) &&
        std::holds_alternative<std::int64_t>(value))
        value = static_cast<double>(std::get<std::int64_t>(value));
    if (value.index() != parameter.fallback.index())
        throw fail(kTypeNames[parameter.fallback.index()]);

    if (const auto* text = std::get_if<std::string>(&value)) {
        const auto& choices = parameter.choices;
        if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end())
            throw fail(fmt::format("one of {}", fmt::join(choices, ", ")));
        return value;
    }
    double number = 0;
    if (const auto* real = std::get_if<double>(&value)) number = *real;
    if (const auto* integer = std::get_if<std::int64_t>(&value))
        number = static_cast<double>(*integer);
    if (!std::holds_alternative<bool>(value) &&
        !(number >= parameter.minimum && number <= parameter.maximum))
        throw fail(fmt::format("a value from {} to {}", parameter.minimum, parameter.maximum));
    return value;
}

}  // namespace

std::string to_string(const Value& value) {
    return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

std::string closest(std::string_view word, std::span<const std::string> candidates) {
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

Settings Settings::resolve(std::span<const Parameter> parameters,
                           const std::map<std::string, Value>& given) {
    std::vector<std::string> names;
    for (const Parameter& p : parameters) names.push_back(p.name);
    for (const auto& [key, value] : given) {
        if (std::find(names.begin(), names.end(), key) != names.end()) continue;
        const std::string near = closest(key, names);
        throw SettingError(
            key, near.empty()
                     ? fmt::format("unknown key '{}'; known keys: {}", key, fmt::join(names, ", "))
                     : fmt::format("unknown key '{}'; did you mean '{}'?", key, near));
    }
    Settings settings;
    for (const Parameter& p : parameters) {
        const auto it = given.find(p.name);
        const Value value = it == given.end() ? p.fallback : checked(p, it->second);
        if (value != p.fallback)
            settings.label_ += fmt::format("{}{}={}", settings.label_.empty() ? "" : ",", p.name,
                                           to_string(value));
        settings.values_.emplace(p.name, value);
    }
    if (settings.label_.empty()) settings.label_ = "default";
    return settings;
}

namespace {
template <typename T>
const T& get(const Settings& settings, std::string_view name) {
    const auto it = settings.values().find(name);
    if (it == settings.values().end() || !std::holds_alternative<T>(it->second))
        throw std::logic_error(fmt::format("no parameter '{}' of this type", name));
    return std::get<T>(it->second);
}
}  // namespace

bool Settings::boolean(std::string_view name) const { return get<bool>(*this, name); }
std::int64_t Settings::integer(std::string_view name) const {
    return get<std::int64_t>(*this, name);
}
double Settings::real(std::string_view name) const { return get<double>(*this, name); }
const std::string& Settings::text(std::string_view name) const {
    return get<std::string>(*this, name);
}

}  // namespace structures
