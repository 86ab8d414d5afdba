// The list of generators.
#include "experiments/scenes/generators.hpp"

#include <array>

#include "experiments/scenes/generator_rows.hpp"

namespace experiments::scenes {

std::span<const GeneratorRow> generators() {
    static const std::array<GeneratorRow, 8> rows = {spheres(),   city(),      pipes(),  hairball(),
                                                     bird_cage(), tentacles(), meshes(), crowd()};
    return rows;
}

}  // namespace experiments::scenes
