// The stress tests: each row builds tiny scenes with lights, points and expected answers that a
// careless shadow method gets wrong.
//
//     for (const StressTest& test : suite())
//         for (const Light::Type type : test.light_types())
//             for (const Scene& scene : test.build(type)) ...
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/stability/scene.hpp"

namespace experiments::stability {

enum class Lights : std::uint8_t { both, point, directional };

struct StressTest {
    int number;             ///< from 1; unique
    std::string_view name;  ///< unique, of letters, digits and underscores
    std::string_view checks;
    std::vector<Scene> (*build)(Light::Type type);
    Lights lights = Lights::both;
    int most = 1000;  ///< variations of a kind at most, for scenes that take long

    /// "04_shared_edge": the `scene` of the results.
    std::string label() const;
    std::vector<Light::Type> light_types() const;
};

/// In the order of their numbers.
std::span<const StressTest> suite();

/// The builders, by theme; what each one is for stands in the table of suite().
using Scenes = std::vector<Scene>;
// edges.cpp
Scenes quad_diagonal(Light::Type type);
Scenes fan_vertex(Light::Type type);
Scenes integer_boxes(Light::Type type);
Scenes shared_edge(Light::Type type);
Scenes wedge_mid_edge(Light::Type type);
Scenes single_sheet(Light::Type type);
// planes.cpp
Scenes light_in_plane(Light::Type type);
Scenes light_on_triangle(Light::Type type);
Scenes slivers(Light::Type type);
Scenes two_sheets(Light::Type type);
// lights.cpp
Scenes closed_room(Light::Type type);
Scenes no_casters(Light::Type type);
Scenes caster_beyond(Light::Type type);
Scenes caster_behind_camera(Light::Type type);
// scale.cpp
Scenes far_light(Light::Type type);
Scenes far_from_origin(Light::Type type);
Scenes contact_shadow(Light::Type type);
// round.cpp
Scenes light_inside_round(Light::Type type);
Scenes long_cable(Light::Type type);
Scenes balls_at_threshold(Light::Type type);
Scenes capsule_end_on(Light::Type type);
Scenes crossing_capsules(Light::Type type);
// crowds.cpp
Scenes piercing_plate(Light::Type type);
Scenes repeated_triangle(Light::Type type);
Scenes coaxial_clusters(Light::Type type);
Scenes closed_and_cancelling(Light::Type type);
Scenes spokes(Light::Type type);
Scenes broken_triangles(Light::Type type);

}  // namespace experiments::stability
