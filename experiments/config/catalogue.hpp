// What a config may name: the scene generators, structures and shadow methods of this program, each
// with the keys it takes. Read from the registries once, so that a config is checked without a
// device.
#pragma once

#include <span>
#include <string>
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

Catalogue make_catalogue(std::span<const structures::StructureRow> structures,
                         std::span<const shadows::MethodRow> methods);

}  // namespace experiments::config
