// Clusters without triangles, made directly: what tests of metric trees are built from.
#pragma once

#include <random>

#include "structures/metric_tree/clustering.hpp"
#include "structures/metric_tree/metric.hpp"

namespace tests {

using structures::geometry::Aabb;
using structures::geometry::Light;
using structures::metric_tree::Cluster;
using structures::metric_tree::Clustering;

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    std::size_t below(std::size_t count) { return engine_() % count; }
    glm::dvec3 in_box(double half) {
        return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
    }
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 v = in_box(1);
            const double square = glm::dot(v, v);
            if (square > 1e-4 && square <= 1) return v / std::sqrt(square);
        }
    }
    glm::dvec3 in_ball() { return direction() * std::cbrt(uniform(0, 1)); }

  private:
    std::mt19937_64 engine_;
};

/// A cluster whose triangles may face any way.
inline Cluster make_cluster(const glm::dvec3& a, const glm::dvec3& b, double radius) {
    Cluster cluster{};
    cluster.a = a;
    cluster.b = b;
    cluster.radius = static_cast<float>(radius);
    cluster.cone_cosine = -1;
    cluster.axis = {0, 0, 1};
    cluster.count = 1;
    return cluster;
}

inline Aabb bounds_of(const Clustering& clustering) {
    Aabb box;
    for (const Cluster& cluster : clustering.clusters)
        for (const glm::vec3 end : {cluster.a, cluster.b}) {
            box.grow(end - cluster.radius);
            box.grow(end + cluster.radius);
        }
    return box;
}

/// In the cube from -1 to 1: balls, and capsules up to ten times as long as they are thick.
inline Clustering random_clusters(std::size_t count, bool capsules, std::uint64_t seed) {
    Random random(seed);
    Clustering clustering;
    const double size = 0.5 / std::cbrt(count + 1.0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 center = random.in_box(1);
        const double radius = size * random.uniform(0.1, 1);
        glm::dvec3 half(0);
        if (capsules && i % 3 == 0) half = random.direction() * radius * random.uniform(1, 10);
        clustering.clusters.push_back(make_cluster(center - half, center + half, radius));
        clustering.capsule_count += half != glm::dvec3(0);
    }
    return clustering;
}

}  // namespace tests
