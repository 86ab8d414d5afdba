// Creatures: every limb is a tube of varying radius along a spline through a few spheres.
#include "experiments/scenes/creatures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/scenes/spline.hpp"

namespace experiments::scenes {
namespace {

using structures::geometry::TriangleMesh;

/// A sphere that a limb passes through: centre and radius. Limbs begin and end in points.
using Knot = glm::dvec4;
using Limb = std::vector<Knot>;

struct Plan {
    Limb trunk;               ///< from the tip of the tail to the snout
    std::vector<Limb> pairs;  ///< on the side z > 0; each has a mirror image
};

const Plan& plan_of(Species species) {
    static const Plan kRaptor = {{{-2.2, 1.25, 0.1, 0},
                                  {-1.4, 1.15, 0, 0.07},
                                  {-0.7, 1.15, 0, 0.17},
                                  {-0.1, 1.2, 0, 0.34},
                                  {0.4, 1.35, 0, 0.3},
                                  {0.75, 1.65, 0, 0.15},
                                  {0.95, 1.95, 0, 0.12},
                                  {1.15, 2.08, 0, 0.16},
                                  {1.4, 2.0, 0, 0.1},
                                  {1.65, 1.92, 0, 0}},
                                 {{{-0.05, 1.25, 0.15, 0},
                                   {0.05, 1, 0.28, 0.17},
                                   {0.15, 0.7, 0.3, 0.12},
                                   {-0.15, 0.35, 0.3, 0.055},
                                   {-0.05, 0.08, 0.3, 0.05},
                                   {0.15, 0.03, 0.3, 0.045},
                                   {0.3, 0, 0.3, 0}},
                                  {{0.4, 1.3, 0.15, 0},
                                   {0.5, 1.15, 0.27, 0.07},
                                   {0.65, 0.95, 0.27, 0.045},
                                   {0.95, 0.93, 0.22, 0}}}};
    static const Plan kDragon = {{{-2.4, 0.5, 0.6, 0},
                                  {-1.9, 0.35, 0.4, 0.07},
                                  {-1.3, 0.55, 0, 0.14},
                                  {-0.7, 0.85, 0, 0.3},
                                  {0, 0.95, 0, 0.38},
                                  {0.6, 1, 0, 0.32},
                                  {1, 1.3, 0, 0.17},
                                  {1.2, 1.65, 0, 0.13},
                                  {1.45, 1.82, 0, 0.19},
                                  {1.75, 1.72, 0, 0.12},
                                  {2, 1.62, 0, 0}},
                                 {{{-0.6, 0.95, 0.2, 0},
                                   {-0.6, 0.75, 0.33, 0.2},
                                   {-0.45, 0.45, 0.36, 0.11},
                                   {-0.65, 0.2, 0.36, 0.07},
                                   {-0.55, 0.06, 0.36, 0.07},
                                   {-0.3, 0, 0.36, 0}},
                                  {{0.5, 1, 0.2, 0},
                                   {0.5, 0.75, 0.33, 0.14},
                                   {0.4, 0.45, 0.35, 0.08},
                                   {0.5, 0.06, 0.35, 0.07},
                                   {0.75, 0, 0.35, 0}},
                                  {{1.5, 1.9, 0.08, 0},
                                   {1.35, 2, 0.13, 0.05},
                                   {1.15, 2.15, 0.2, 0.03},
                                   {0.95, 2.35, 0.2, 0}}}};
    static const Plan kSnake = {{{1.1, 0.05, -0.1, 0},
                                 {0.8, 0.1, 0.7, 0.08},
                                 {0, 0.13, 1, 0.12},
                                 {-0.8, 0.15, 0.6, 0.14},
                                 {-0.9, 0.16, -0.3, 0.15},
                                 {-0.3, 0.17, -0.8, 0.16},
                                 {0.45, 0.2, -0.5, 0.16},
                                 {0.55, 0.3, 0.15, 0.16},
                                 {0.05, 0.45, 0.4, 0.16},
                                 {-0.35, 0.75, 0.1, 0.15},
                                 {-0.1, 1.15, -0.1, 0.14},
                                 {0.2, 1.5, 0, 0.12},
                                 {0.45, 1.78, 0, 0.12},
                                 {0.7, 1.85, 0, 0.17},
                                 {1.1, 1.76, 0, 0}},
                                {}};
    static const Plan kBird = {{{-1.1, 0.45, 0, 0},
                                {-0.75, 0.55, 0, 0.08},
                                {-0.4, 0.75, 0, 0.22},
                                {0, 0.95, 0, 0.36},
                                {0.35, 1.2, 0, 0.3},
                                {0.5, 1.42, 0, 0.2},
                                {0.62, 1.62, 0, 0.22},
                                {0.82, 1.64, 0, 0.1},
                                {1.1, 1.58, 0, 0}},
                               {{{0.35, 1.25, 0.2, 0},
                                 {0.15, 1.15, 0.31, 0.12},
                                 {-0.3, 0.9, 0.31, 0.14},
                                 {-0.7, 0.65, 0.22, 0.07},
                                 {-1, 0.45, 0.15, 0}},
                                {{0, 0.8, 0.12, 0},
                                 {0.02, 0.45, 0.15, 0.06},
                                 {0.05, 0.05, 0.15, 0.04},
                                 {0.3, 0, 0.15, 0}}}};
    static const Plan* const kPlans[kSpecies] = {&kRaptor, &kDragon, &kSnake, &kBird};
    return *kPlans[static_cast<std::uint32_t>(species)];
}

/// Every individual is built a little differently; tips stay tips.
Limb individual(const Limb& limb, Random& random, double side) {
    Limb result = limb;
    for (Knot& knot : result) {
        for (int axis = 0; axis < 3; ++axis) knot[axis] += random.uniform(-0.03, 0.03);
        knot.y = std::max(knot.y, 0.0) + 0.7 * knot.w * (knot.y < 0.1);  // feet stay above ground
        knot.z *= side;
        knot.w *= random.uniform(0.85, 1.15);
    }
    return result;
}

/// Half the surface, about: what a limb's share of the triangles goes by.
double extent(const Limb& limb) {
    double sum = 0;
    for (std::size_t i = 1; i < limb.size(); ++i)
        sum += glm::length(glm::dvec3(limb[i] - limb[i - 1])) * (limb[i].w + limb[i - 1].w);
    return sum;
}

std::size_t least_rings(const Limb& limb) { return limb.size() + 1; }

/// Evenly spread over the spline's parameter.
std::vector<Ring> rings_along(const Limb& limb, std::size_t count) {
    std::vector<Ring> rings(count);
    for (std::size_t r = 0; r < count; ++r) {
        const double at = double(r) / double(count - 1) * double(limb.size() - 1);
        const auto [p, slope] = on_spline<Knot>(limb, at);
        rings[r] = {glm::dvec3(p), glm::normalize(glm::dvec3(slope)), std::max(p.w, 0.004)};
    }
    rings.front().radius = rings.back().radius = 0;
    return rings;
}

/// Bumps: products of a wave along the limb and one around it, from folds down to scales.
class Skin {
  public:
    Skin(Random& random, std::size_t rings, std::size_t sides) : along_(rings), around_(sides) {
        constexpr glm::dvec3 kWaves[kCount] = {
            {5, 2, 0.06}, {23, 7, 0.04}, {61, 19, 0.025}, {149, 41, 0.012}};
        for (int k = 0; k < kCount; ++k) {
            const double phase = random.uniform(), shift = random.uniform();
            for (std::size_t r = 0; r < rings; ++r)
                along_[r][k] =
                    kWaves[k].z * unit_circle(kWaves[k].x * double(r) / double(rings) + phase).x;
            for (std::size_t i = 0; i < sides; ++i)
                around_[i][k] = unit_circle(kWaves[k].y * double(i) / double(sides) + shift).x;
        }
    }
    double operator()(std::size_t ring, std::size_t side) const {
        return 1 + glm::dot(along_[ring], around_[side]);
    }

  private:
    static constexpr int kCount = 4;
    std::vector<glm::dvec4> along_, around_;
};

/// Adds `triangles` triangles or up to a row around more.
void add_limb(TriangleMesh& mesh, Random& random, const Limb& limb, std::size_t triangles) {
    double length = 0;
    for (std::size_t i = 1; i < limb.size(); ++i)
        length += glm::length(glm::dvec3(limb[i] - limb[i - 1]));
    // About as fine around as along: a row of squares is `circumference` long.
    const double circumference = 3.1416 * extent(limb) / length;
    const auto sides = static_cast<std::size_t>(
        std::max(3.0, std::sqrt(0.5 * double(triangles) * circumference / length)));
    // Two rows of triangles per stretch, one at either tip.
    const std::size_t rings =
        std::max(least_rings(limb), 2 + (triangles + 2 * sides - 1) / (2 * sides));
    add_tube(mesh, rings_along(limb, rings), sides, Skin(random, rings, sides));
}

}  // namespace

TriangleMesh creature(Species species, Random& random, std::size_t triangles) {
    const Plan& plan = plan_of(species);
    const Limb trunk = individual(plan.trunk, random, 1);
    std::vector<Limb> limbs;
    for (const Limb& limb : plan.pairs)
        for (const double side : {1.0, -1.0}) limbs.push_back(individual(limb, random, side));
    double whole = extent(trunk);
    for (const Limb& limb : limbs) whole += extent(limb);

    TriangleMesh mesh;
    mesh.triangles.reserve(triangles + triangles / 50 + 2 * kLeastCreature);
    mesh.positions.reserve(triangles / 2 + triangles / 100 + 2 * kLeastCreature);
    for (const Limb& limb : limbs)
        add_limb(mesh, random, limb,
                 static_cast<std::size_t>(double(triangles) * extent(limb) / whole));
    add_limb(mesh, random, trunk, triangles - std::min(triangles, mesh.triangle_count()));

    float lowest = mesh.positions[0].y;
    for (const glm::vec3 p : mesh.positions) lowest = std::min(lowest, p.y);
    for (glm::vec3& p : mesh.positions) p.y -= lowest + 0.02f;
    return mesh;
}

}  // namespace experiments::scenes
