// Parameters that a structure or a shadow method declares, and the settings a config gives them.
//
//     static const Parameter kParameters[] = {
//         {"leaf_size", std::int64_t{4}, "triangles per leaf at most", {}, 1, 64},
//         {"split", std::string("binned_sah"), "split rule", {"binned_sah", "spatial_median"}},
//     };
//     Settings settings = Settings::resolve(kParameters, {{"leaf_size", std::int64_t{8}}});
//     settings.integer("leaf_size");   // 8
//     settings.label();                // "leaf_size=8": the keys that differ from the defaults
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace structures {

using Value = std::variant<bool, std::int64_t, double, std::string>;

/// "true", "12", "0.5", "text".
std::string to_string(const Value& value);

struct Parameter {
    std::string name;
    Value fallback;  ///< default; its alternative is the parameter's type
    std::string help;
    std::vector<std::string> choices{};  ///< for strings: the allowed values (empty: any)
    double minimum = -std::numeric_limits<double>::infinity();  ///< for numbers, inclusive
    double maximum = std::numeric_limits<double>::infinity();
};

/// Thrown by Settings::resolve: `key` is at fault, what() says what was expected.
struct SettingError : std::invalid_argument {
    SettingError(std::string key_name, const std::string& message)
        : std::invalid_argument(message), key(std::move(key_name)) {}
    std::string key;
};

class Settings {
  public:
    /// Checks names, types, choices and ranges; fills in defaults. An integer is accepted where a
    /// double is expected. Throws SettingError naming the closest known key for an unknown one.
    static Settings resolve(std::span<const Parameter> parameters,
                            const std::map<std::string, Value>& given);

    bool boolean(std::string_view name) const;
    std::int64_t integer(std::string_view name) const;
    double real(std::string_view name) const;
    const std::string& text(std::string_view name) const;

    const std::map<std::string, Value, std::less<>>& values() const { return values_; }
    /// "key=value,key=value" of the keys that differ from their defaults; "default" if none does.
    const std::string& label() const { return label_; }

  private:
    std::map<std::string, Value, std::less<>> values_;
    std::string label_;
};

/// The candidate closest to `word` in edit distance, or empty if none is near.
std::string closest(std::string_view word, std::span<const std::string> candidates);

}  // namespace structures
