// Pivots and elements in every position to each other that distances might get wrong.
#pragma once

#include <vector>

#include "tests/structures/clusters.hpp"

namespace tests {

using structures::metric_tree::Element;

struct ElementPair {
    Element pivot, element;
};

/// Ends as single precision holds them.
inline Element stored(Element element) {
    element.a = glm::vec3(element.a);
    element.b = glm::vec3(element.b);
    element.radius = static_cast<float>(element.radius);
    return element;
}

/// The nearest place that a scene can have.
inline glm::dvec3 in_disc(const glm::dvec3& place) {
    return place * std::min(1.0, 3.5 / std::max(glm::length(place), 1e-9));
}

/// Directions (or places in the plane, up to 3.5 from its origin) from `from`, at a distance of up
/// to `way`, and of `way` itself once in a while.
inline glm::dvec3 step(Random& random, bool directional, const glm::dvec3& from, double way) {
    if (random.below(4) != 0) way *= random.uniform(0, 1);
    if (directional) {
        const double turn = random.uniform(0, 6.283185307179586);
        return in_disc(from + way * glm::dvec3(std::cos(turn), std::sin(turn), 0));
    }
    const glm::dvec3 across = glm::normalize(glm::cross(from, random.direction()));
    return glm::normalize(from * std::cos(way) + across * std::sin(way));
}

/// Arcs of at most 90 degrees: anywhere, sharing an end, crossing, one along the other, one's
/// middle on the other, opposite, points; lengths and distances from 1 down to 10^-8.
inline std::vector<ElementPair> element_pairs(std::size_t count, bool directional,
                                              std::uint64_t seed) {
    Random random(seed);
    const double widest = 0.5 * 3.14159265;
    const auto length = [&] {
        return widest * std::pow(10, -random.uniform(0, 1) * random.below(9));
    };
    const auto somewhere = [&] {
        glm::dvec3 p = random.direction();
        if (random.below(8) == 0) {
            p = {0, 0, 0};
            p[int(random.below(directional ? 2 : 3))] = random.below(2) == 0 ? 1 : -1;
        }
        return directional ? glm::dvec3(3.5 * p.x, 3.5 * p.y, 0) : p;
    };
    const auto between = [&](const Element& e, double t) {
        const glm::dvec3 p = glm::mix(e.a, e.b, t);
        return directional ? p : glm::normalize(p);
    };
    std::vector<ElementPair> pairs(count);
    for (std::size_t i = 0; i < count; ++i) {
        Element &pivot = pairs[i].pivot, &element = pairs[i].element;
        pivot.a = somewhere();
        pivot.b = random.below(4) == 0 ? pivot.a : step(random, directional, pivot.a, length());
        const double t = random.uniform(0, 1), s = random.uniform(0, 1);
        switch (i % 7) {
            case 0:
                element.a = somewhere();
                element.b = step(random, directional, element.a, length());
                break;
            case 1:
                element.a = pivot.b;
                element.b = step(random, directional, element.a, length());
                break;
            case 2: {  // crossing
                const glm::dvec3 cross = between(pivot, t);
                element.a = step(random, directional, cross, 0.5 * length());
                element.b = directional ? in_disc(2.0 * cross - element.a)
                                        : 2.0 * glm::dot(element.a, cross) * cross - element.a;
                break;
            }
            case 3:
                element.a = between(pivot, t);
                element.b = between(pivot, s);
                break;
            case 4:
                element.a = step(random, directional, between(pivot, t), length());
                element.b = step(random, directional, between(pivot, s), length());
                break;
            case 5:
                element.a = -between(pivot, t);
                element.b = step(random, directional, element.a, length());
                break;
            default:
                element.a = element.b = step(random, directional, between(pivot, t), length());
        }
        if (!directional && glm::dot(element.a, element.b) < 0) element.b = element.a;
        element.radius = random.below(3) == 0 ? 0 : std::min(length(), 1.04);
        pairs[i] = {stored(pivot), stored(element)};
    }
    return pairs;
}

}  // namespace tests
