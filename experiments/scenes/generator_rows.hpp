// The generators one by one; generators.cpp lists them.
#pragma once

#include "experiments/scenes/generators.hpp"

namespace experiments::scenes {

/// The largest mesh a generator may be asked for.
inline constexpr double kMaxTriangles = 2e8;

/// Parameter `triangles`; `how` says what it does beyond naming the number wanted.
inline structures::Parameter triangles_parameter(const char* how) {
    return {"triangles", std::int64_t{100000}, std::string("triangles wanted; ") + how, {},
            1000,        kMaxTriangles};
}

GeneratorRow spheres();
GeneratorRow city();
GeneratorRow pipes();
GeneratorRow hairball();
GeneratorRow bird_cage();
GeneratorRow tentacles();
GeneratorRow meshes();
GeneratorRow crowd();

}  // namespace experiments::scenes
