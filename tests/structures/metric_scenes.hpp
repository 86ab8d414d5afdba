// Clusterings made by hand, one triangle per cluster: what builders of metric trees are tested
// with.
#pragma once

#include <cmath>
#include <random>

#include "structures/metric_tree/clustering.hpp"
#include "tests/structures/meshes.hpp"

namespace tests {

struct MetricScene {
    TriangleMesh mesh;
    structures::metric_tree::Clustering clustering;

    /// A ball if a == b, else a capsule; with a triangle inside, and normals that may be any.
    void add(glm::vec3 a, glm::vec3 b, float radius) {
        const glm::vec3 side(0, 0.5f * radius, 0), up(0, 0, 0.5f * radius);
        structures::metric_tree::Cluster cluster{};
        cluster.a = a;
        cluster.b = b;
        cluster.radius = radius;
        cluster.cone_cosine = -1;
        cluster.axis = {1, 0, 0};
        const auto id = static_cast<std::uint32_t>(mesh.triangle_count());
        add_triangle(mesh, a + side, b + up, 0.5f * (a + b) - 0.9f * side);
        cluster.slab_low = std::min(a.x, b.x) - radius;
        cluster.slab_high = std::max(a.x, b.x) + radius;
        cluster.first = id;
        cluster.count = 1;
        clustering.clusters.push_back(cluster);
        clustering.order.push_back(id);
        clustering.capsule_count += a != b ? 1 : 0;
    }
    void add_ball(glm::vec3 center, float radius) { add(center, center, radius); }
};

/// `count` clusters in the unit cube, a share of them capsules of up to `length`.
inline MetricScene random_clusters(std::size_t count, std::uint32_t seed,
                                   double capsule_share = 0.2, float radius = 0.01f,
                                   float length = 0.2f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1), way(-length, length);
    MetricScene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 a(unit(random), unit(random), unit(random));
        const glm::vec3 along(way(random), way(random), way(random));
        const bool capsule = unit(random) < capsule_share;
        scene.add(a, capsule ? a + along : a, radius * (0.1f + unit(random)));
    }
    return scene;
}

}  // namespace tests
