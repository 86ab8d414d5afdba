// Densely tessellated closed models: animals with a skin of bumps, each a few limbs that overlap.
//
//     Random random(seed);
//     TriangleMesh raptor = creature(Species::raptor, random, 100'000);
//     add_copy(mesh, raptor, {4, 0, 2}, 0.25);
#pragma once

#include "experiments/scenes/shapes.hpp"

namespace experiments::scenes {

enum class Species { raptor, dragon, snake, bird };
inline constexpr std::uint32_t kSpecies = 4;

/// No creature has fewer triangles.
inline constexpr std::size_t kLeastCreature = 250;

/// An individual of `triangles` triangles or a few more (one row around its trunk at most, and
/// kLeastCreature at least). It stands on the ground at the origin, sunk in by 0.02, and looks
/// along x; it is 1.6 to 2.4 high and reaches up to 2.8 from the vertical through the origin. Every
/// limb is a closed surface; limbs pass through each other where they meet.
structures::geometry::TriangleMesh creature(Species species, Random& random, std::size_t triangles);

}  // namespace experiments::scenes
