#include "experiments/stability/suite.hpp"

#include <fmt/format.h>

namespace experiments::stability {
namespace {

using enum Lights;

constexpr StressTest kSuite[] = {
    {1, "quad_diagonal", "no light through the diagonal of a quad", quad_diagonal},
    {2, "fan_vertex", "no light through the hub of a fan, nor an ulp beside it", fan_vertex},
    {3, "integer_boxes", "exact zeros: integer boxes and light, points at halves", integer_boxes},
    {4, "shared_edge", "no light through an edge of constant x", shared_edge},
    {5, "wedge_mid_edge", "a triangle's shadow reaches its edge's middle", wedge_mid_edge},
    {6, "closed_room", "a light in a closed room lights the inside only", closed_room},
    {7, "piercing_plate", "small triangles through a plate cast above it", piercing_plate},
    {8, "no_casters", "nothing, or nothing in between, casts nothing", no_casters},
    {9, "repeated_triangle", "100,000 equal triangles cast as one does", repeated_triangle, both,
     1},
    {10, "coaxial_clusters", "10,000 casters in a row: lit before the first", coaxial_clusters,
     both, 2},
    {11, "light_in_plane", "a triangle in the plane of the light casts nothing", light_in_plane},
    {12, "light_on_triangle", "a light on a vertex, edge or face: segments are open",
     light_on_triangle, point},
    {13, "light_inside_round", "a light inside a ball or a capsule, on its axis",
     light_inside_round, point},
    {14, "long_cable", "a thin cable close to the light casts along all its shadow", long_cable},
    {15, "caster_beyond", "a caster on the light's other side casts nothing", caster_beyond},
    {16, "far_light", "a caster of 0.5 m casts under a light 10 km away", far_light},
    {17, "far_from_origin", "a scene 2^20 off the origin, on its rounded input", far_from_origin},
    {18, "slivers", "aspect 10^6 and edges 10^-4 rad off the light's rays", slivers},
    {19, "contact_shadow", "the shadow next to a box on a floor, at every scale", contact_shadow},
    {20, "two_sheets", "of two parallel sheets 64 epsilon apart, the upper is lit", two_sheets},
    {21, "single_sheet", "an open sheet casts, whichever way it is wound", single_sheet},
    {22, "closed_and_cancelling", "closed tetrahedra and opposite normals are not culled",
     closed_and_cancelling},
    {23, "balls_at_threshold", "balls whose near or far side is at a split's threshold",
     balls_at_threshold},
    {24, "spokes", "5,000 large triangles that cross each other's planes", spokes, both, 2},
    {25, "capsule_end_on", "a capsule along the light's direction casts a disc", capsule_end_on,
     directional},
    {26, "broken_triangles", "triangles with NaN, infinity or no area change nothing",
     broken_triangles},
    {27, "caster_behind_camera", "a caster behind the camera casts into the view",
     caster_behind_camera},
    {28, "crossing_capsules", "two long capsules that cross at right angles, to their ends",
     crossing_capsules},
};

}  // namespace

std::string StressTest::label() const { return fmt::format("{:02}_{}", number, name); }

std::vector<Light::Type> StressTest::light_types() const {
    std::vector<Light::Type> types;
    if (lights != Lights::directional) types.push_back(Light::Type::point);
    if (lights != Lights::point) types.push_back(Light::Type::directional);
    return types;
}

std::span<const StressTest> suite() { return kSuite; }

}  // namespace experiments::stability
