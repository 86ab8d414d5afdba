// A crowd on a plain: many copies of a few creatures, placed and turned rigidly, written out as one
// mesh. The scene of the largest triangle counts.
#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/scenes/creatures.hpp"
#include "experiments/scenes/generator_rows.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;
using structures::geometry::TriangleMesh;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("copies are added until there"),
        {"model_triangles",
         std::int64_t{10000},
         "triangles of a copy, about; fewer where that would make less than 16 copies",
         {},
         static_cast<double>(kLeastCreature),
         1e7},
        {"models", std::int64_t{8}, "different models", {}, 1, 64},
        {"spacing", 3.5, "mean distance of neighbours, metres", {}, 1, 20},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto each =
        std::clamp<std::size_t>(triangles / 16, kLeastCreature,
                                static_cast<std::size_t>(settings.integer("model_triangles")));
    const double spacing = settings.real("spacing");
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    std::vector<TriangleMesh> models;
    for (std::uint32_t i = 0; i < settings.integer("models"); ++i)
        models.push_back(creature(static_cast<Species>(i % kSpecies), random, each));

    GeneratedScene scene;
    TriangleMesh& mesh = scene.mesh;
    mesh.triangles.reserve(triangles + 2 * kLeastCreature);
    mesh.positions.reserve(triangles / 2 + triangles / 50 + 2 * kLeastCreature);
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(double(triangles / each + 1))));
    const double half = 0.5 * spacing * double(side);
    add_ground(mesh, half + spacing);
    for (std::size_t i = 0; mesh.triangle_count() < triangles; ++i) {
        // From the front to the back, anywhere in the middle of a cell, looking anywhere.
        const glm::dvec2 cell(double(i % side), double(i / side));
        const glm::dvec2 place =
            cell + glm::dvec2(random.uniform(0.3, 0.7), random.uniform(0.3, 0.7));
        const glm::dvec3 at(spacing * place.x - half, 0, half - spacing * place.y);
        const double turns = random.uniform();
        const TriangleMesh& model = models[random.index(static_cast<std::uint32_t>(models.size()))];
        const std::size_t left = triangles - mesh.triangle_count();
        if (left >= model.triangle_count())
            add_copy(mesh, model, at, turns);
        else  // the last is as coarse as it takes
            add_copy(mesh, creature(Species::bird, random, left), at, turns);
    }

    const auto size = static_cast<float>(half);
    scene.camera = {
        {0.3f * size, 3 + 0.35f * size, 1.25f * size + 3}, {0, 0, 0.2f * size}, {0, 1, 0}, 50};
    scene.light = {structures::geometry::Light::Type::point,
                   {-0.6f * size, 6 + 0.35f * size, 0.2f * size}};
    return scene;
}

}  // namespace

GeneratorRow crowd() {
    return {"crowd", "copies of a few creatures all over a plain", &parameters, &generate};
}

}  // namespace experiments::scenes
