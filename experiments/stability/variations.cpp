#include "experiments/stability/variations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

namespace experiments::stability {
namespace {

/// The largest coordinate of anything finite in the scene.
double extent(const Scene& scene) {
    double largest = 0;
    const auto grow = [&](glm::vec3 p) {
        for (int axis = 0; axis < 3; ++axis)
            if (std::isfinite(p[axis])) largest = std::max<double>(largest, std::abs(p[axis]));
    };
    for (const glm::vec3& p : scene.mesh.positions) grow(p);
    for (const ScenePoint& point : scene.points) grow(point.position);
    if (scene.light.type == Light::Type::point) grow(scene.light.vector);
    return largest;
}

/// Maps every position, and directions without the shift.
template <typename Map>
void map_positions(Scene& scene, const Map& map, glm::dvec3 shift) {
    for (glm::vec3& p : scene.mesh.positions) p = map(glm::dvec3(p)) + shift;
    for (ScenePoint& point : scene.points) point.position = map(glm::dvec3(point.position)) + shift;
    glm::vec3& light = scene.light.vector;
    light =
        map(glm::dvec3(light)) + (scene.light.type == Light::Type::point ? shift : glm::dvec3(0));
}

void transform(Scene& scene, std::uint64_t seed) {
    scenes::Random random(seed);
    const glm::dvec3 axis = random.direction();
    const glm::dquat turn = glm::angleAxis(random.uniform(0, 2 * 3.14159265358979), axis);
    const glm::dvec3 shift = extent(scene) * random.uniform() * random.direction();
    map_positions(
        scene, [&](glm::dvec3 p) { return turn * p; }, shift);
}

void reorder(Scene& scene, std::uint64_t seed) {
    scenes::Random random(seed);
    const auto count = static_cast<std::uint32_t>(scene.mesh.triangle_count());
    std::vector<std::uint32_t> order(count), place(count);
    std::iota(order.begin(), order.end(), 0u);
    for (std::uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.index(i)]);
    const std::vector<glm::uvec3> old = scene.mesh.triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.mesh.triangles[i] = old[order[i]];
        place[order[i]] = i;
    }
    for (ScenePoint& point : scene.points)
        if (point.receiver < count) point.receiver = place[point.receiver];
    scene.essential = 0;
}

}  // namespace

std::string Variation::label() const {
    switch (kind) {
        case Kind::transform:
            return fmt::format("transform {}", seed);
        case Kind::order:
            return fmt::format("order {}", seed);
        case Kind::scale:
            return fmt::format("scale {}", factor);
        default:
            return "as built";
    }
}

std::vector<Variation> variations(const Selection& selection, std::int64_t seed, int most) {
    std::vector<Variation> list(1);
    const auto first = static_cast<std::uint64_t>(seed) * 1000;
    for (int i = 0; i < std::min(selection.transforms, most); ++i)
        list.push_back({Variation::Kind::transform, first + i});
    for (int i = 0; i < std::min(selection.orders, most); ++i)
        list.push_back({Variation::Kind::order, first + i});
    for (int i = 0; i < std::min(int(selection.scales.size()), most); ++i)
        list.push_back({Variation::Kind::scale, 0, selection.scales[i]});
    return list;
}

Scene vary(const Scene& scene, const Variation& variation) {
    Scene varied = scene;
    switch (variation.kind) {
        case Variation::Kind::transform:
            transform(varied, variation.seed);
            break;
        case Variation::Kind::order:
            reorder(varied, variation.seed);
            break;
        case Variation::Kind::scale:
            map_positions(
                varied, [&](glm::dvec3 p) { return variation.factor * p; }, glm::dvec3(0));
            break;
        case Variation::Kind::none:
            break;
    }
    varied.as_built = scene.as_built && variation.keeps_coordinates();
    return varied;
}

}  // namespace experiments::stability
