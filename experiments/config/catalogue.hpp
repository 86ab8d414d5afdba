// What a config may name: the scene generators, structures and shadow methods of this program, each
// with the keys it takes. Read from the registries once, so that a config is checked without a
// device.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "shadows/method.hpp"
#include "structures/structure.hpp"

namespace experiments::config {

struct Entry {
    std::string name;
    std::string summary;
    std::span<const structures::Parameter> parameters;
};
using Entries = std::vector<Entry>;

struct Catalogue {
    Entries generators;
    Entries structures;
    Entries methods;
};

/// The entry of that name, or nullptr.
const Entry* find(const Entries& entries, std::string_view name);
std::vector<std::string> names(const Entries& entries);

/// The row that a config names; it was checked against the same rows.
template <typename Row>
const Row& find_row(std::span<const Row> rows, std::string_view name) {
    for (const Row& row : rows)
        if (row.name == name) return row;
    throw std::logic_error("'" + std::string(name) + "' has left the registry");
}

Catalogue make_catalogue(std::span<const structures::StructureRow> structures,
                         std::span<const shadows::MethodRow> methods);

}  // namespace experiments::config
