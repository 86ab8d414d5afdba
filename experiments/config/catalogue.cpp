#include "experiments/config/catalogue.hpp"

#include "experiments/scenes/generators.hpp"

namespace experiments::config {

const Entry* find(const Entries& entries, std::string_view name) {
    for (const Entry& entry : entries)
        if (entry.name == name) return &entry;
    return nullptr;
}

std::vector<std::string> names(const Entries& entries) {
    std::vector<std::string> list;
    for (const Entry& entry : entries) list.push_back(entry.name);
    return list;
}

Catalogue make_catalogue(std::span<const structures::StructureRow> structures,
                         std::span<const shadows::MethodRow> methods) {
    Catalogue catalogue;
    const auto append = [](Entries& entries, const auto& rows) {
        for (const auto& row : rows)
            entries.push_back({std::string(row.name), std::string(row.summary), row.parameters()});
    };
    append(catalogue.generators, scenes::generators());
    append(catalogue.structures, structures);
    append(catalogue.methods, methods);
    return catalogue;
}

}  // namespace experiments::config
