// A city on flat ground: blocks between streets, cut into lots, each with a stepped tower, a plain
// building with things on its roof, or a gabled house; higher towards the middle. Large flat
// triangles beside small ones, all upright walls axis-aligned. Units are metres.
#include <algorithm>
#include <cmath>

#include "experiments/scenes/generator_rows.hpp"
#include "experiments/scenes/shapes.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;
using structures::geometry::TriangleMesh;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("the city grows outward until there"),
        {"height", 40.0, "mean height of the buildings in the middle, metres", {}, 5, 400},
        {"street", 16.0, "width of the streets, metres", {}, 4, 100},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

constexpr double kBlock = 70;       // side of a block
constexpr double kSidewalk = 0.2;   // its height above the street
constexpr double kLargestLot = 26;  // longer sides are split
constexpr double kStorey = 3.25;

struct Lot {
    glm::dvec2 lower, upper;  // x, z
};

glm::dvec3 at(glm::dvec2 ground, double y) { return {ground.x, y, ground.y}; }

Lot inset(const Lot& lot, double by) { return {lot.lower + by, lot.upper - by}; }

void add_tower(TriangleMesh& mesh, Random& random, Lot lot, double height) {
    const std::uint32_t tiers = 2 + random.index(3);
    double base = kSidewalk;
    for (std::uint32_t i = 0; i < tiers; ++i) {
        const double top = base + height / tiers * random.uniform(0.7, 1.3);
        add_box(mesh, at(lot.lower, base), at(lot.upper, top));
        lot = inset(lot, std::min(lot.upper.x - lot.lower.x, lot.upper.y - lot.lower.y) *
                             random.uniform(0.08, 0.2));
        base = top;
    }
}

void add_flat_roofed(TriangleMesh& mesh, Random& random, const Lot& lot, double height) {
    const double top = kSidewalk + height;
    add_box(mesh, at(lot.lower, kSidewalk), at(lot.upper, top));
    const std::uint32_t things = random.index(4);
    for (std::uint32_t i = 0; i < things; ++i) {
        const glm::dvec2 size(random.uniform(1, 3), random.uniform(1, 3));
        const glm::dvec2 room = lot.upper - lot.lower - size;
        const glm::dvec2 lower =
            lot.lower + glm::dvec2(room.x * random.uniform(), room.y * random.uniform());
        add_box(mesh, at(lower, top), at(lower + size, top + random.uniform(0.8, 3)));
    }
}

/// Walls, and a roof whose ridge runs along the longer side.
void add_house(TriangleMesh& mesh, Random& random, const Lot& lot) {
    const double eaves = kSidewalk + kStorey * (1 + random.index(3));
    const double ridge = eaves + random.uniform(2, 5);
    const glm::dvec2 lower = lot.lower, upper = lot.upper, middle = 0.5 * (lower + upper);
    add_box(mesh, at(lower, kSidewalk), at(upper, eaves));
    const bool along_x = upper.x - lower.x > upper.y - lower.y;
    // a: west or north ridge end, b: the other; corners: counter-clockwise seen from above.
    const glm::dvec3 a =
        along_x ? glm::dvec3(lower.x, ridge, middle.y) : glm::dvec3(middle.x, ridge, lower.y);
    const glm::dvec3 b =
        along_x ? glm::dvec3(upper.x, ridge, middle.y) : glm::dvec3(middle.x, ridge, upper.y);
    const glm::dvec3 nw(lower.x, eaves, lower.y), sw(lower.x, eaves, upper.y);
    const glm::dvec3 se(upper.x, eaves, upper.y), ne(upper.x, eaves, lower.y);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec3 p : {nw, sw, se, ne, a, b}) mesh.positions.emplace_back(p);
    constexpr std::uint32_t kAlongX[6][3] = {{1, 2, 5}, {1, 5, 4}, {3, 0, 4},
                                             {3, 4, 5}, {0, 1, 4}, {2, 3, 5}};
    constexpr std::uint32_t kAlongZ[6][3] = {{0, 1, 5}, {0, 5, 4}, {2, 3, 4},
                                             {2, 4, 5}, {3, 0, 4}, {1, 2, 5}};
    for (const auto& t : along_x ? kAlongX : kAlongZ)
        mesh.triangles.emplace_back(first + t[0], first + t[1], first + t[2]);
}

/// Splits a lot until its sides are short, then builds on it, unless there is enough already.
void build_up(TriangleMesh& mesh, Random& random, const Lot& lot, double height,
              std::size_t enough) {
    const glm::dvec2 size = lot.upper - lot.lower;
    const int axis = size.x > size.y ? 0 : 1;
    if (size[axis] > kLargestLot) {
        Lot one = lot, other = lot;
        one.upper[axis] = other.lower[axis] =
            lot.lower[axis] + size[axis] * random.uniform(0.35, 0.65);
        build_up(mesh, random, one, height, enough);
        build_up(mesh, random, other, height, enough);
        return;
    }
    if (mesh.triangle_count() >= enough) return;
    const Lot plot = inset(lot, random.uniform(0.3, 1.5));
    // Skewed: many low buildings, few high ones.
    const double spread = random.uniform();
    const double own_height = kStorey + height * (0.2 + 2.4 * spread * spread);
    if (own_height > 40)
        add_tower(mesh, random, plot, own_height);
    else if (own_height > 12)
        add_flat_roofed(mesh, random, plot, own_height);
    else
        add_house(mesh, random, plot);
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto seed = static_cast<std::uint64_t>(settings.integer("seed"));
    const double pitch = kBlock + settings.real("street");

    GeneratedScene scene;
    TriangleMesh& mesh = scene.mesh;
    mesh.triangles.reserve(triangles + 64);
    const std::size_t enough = triangles - 2;  // the ground has two
    int ring = 0;
    for (; mesh.triangle_count() < enough; ++ring) {
        for (int z = -ring; z <= ring; ++z)
            for (int x = -ring; x <= ring; ++x) {
                if (std::max(std::abs(x), std::abs(z)) != ring) continue;
                if (mesh.triangle_count() >= enough) continue;
                // A block of its own seed stays as it is when the city grows.
                Random mix(seed + (static_cast<std::uint64_t>(x) << 32));
                Random random(mix.next() + static_cast<std::uint64_t>(z));
                const glm::dvec2 middle(x * pitch, z * pitch);
                const Lot block{middle - kBlock / 2, middle + kBlock / 2};
                add_box(mesh, at(block.lower, 0), at(block.upper, kSidewalk));
                const double height = settings.real("height") / (1 + 0.15 * ring);
                build_up(mesh, random, inset(block, 3), height, enough);
            }
    }
    const double edge = (ring - 0.5) * pitch + settings.real("street");
    add_ground(mesh, edge);

    // Near the middle the view is the same however large the city; the lamp hangs high above it.
    const auto near = static_cast<float>(std::min(edge, 4 * pitch));
    scene.camera = {{0.55f * near, 0.6f * near, 1.1f * near}, {0, 0.05f * near, 0}, {0, 1, 0}, 50};
    scene.light = {structures::geometry::Light::Type::point,
                   {-0.5f * near, 1.4f * near, 0.7f * near}};
    return scene;
}

}  // namespace

GeneratorRow city() {
    return {"city", "blocks of towers, flats and houses between streets", &parameters, &generate};
}

}  // namespace experiments::scenes
