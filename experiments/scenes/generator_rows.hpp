// The generators one by one; generators.cpp lists them.
#pragma once

#include "experiments/scenes/generators.hpp"

namespace experiments::scenes {

/// The largest mesh a generator may be asked for.
inline constexpr double kMaxTriangles = 2e8;

extern const GeneratorRow kSpheres, kCity, kPipes, kHairball;

}  // namespace experiments::scenes
