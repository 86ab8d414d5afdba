// The generators one by one; generators.cpp lists them.
#pragma once

#include "experiments/scenes/generators.hpp"

namespace experiments::scenes {

/// The largest mesh a generator may be asked for.
inline constexpr double kMaxTriangles = 2e8;

GeneratorRow spheres();
GeneratorRow city();
GeneratorRow pipes();
GeneratorRow hairball();
GeneratorRow bird_cage();
GeneratorRow tentacles();
GeneratorRow meshes();
GeneratorRow crowd();

}  // namespace experiments::scenes
