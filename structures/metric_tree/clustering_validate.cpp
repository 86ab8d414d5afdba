// A clustering against its mesh, triangle by triangle.

#include <cmath>

#include "structures/metric_tree/clustering.hpp"
#include "structures/metric_tree/volume.hpp"
#include "structures/violations.hpp"

namespace structures::metric_tree {
namespace {

class Validator : Violations {
  public:
    Validator(const geometry::TriangleMesh& mesh, const Clustering& clustering,
              const ClusterConfig& config)
        : mesh_(mesh), clustering_(clustering), config_(config), uses_(mesh.triangle_count()) {}

    std::vector<std::string> run() {
        std::uint64_t next = 0, capsules = 0;
        for (std::size_t c = 0; c < clustering_.clusters.size(); ++c) {
            const Cluster& cluster = clustering_.clusters[c];
            if (cluster.first != next)
                fail("cluster {}: begins at {}, the one before it ended at {}", c, cluster.first,
                     next);
            next = std::uint64_t{cluster.first} + cluster.count;
            capsules += cluster.a != cluster.b;
            check_form(c, cluster);
            check_triangles(c, cluster);
        }
        if (next != clustering_.order.size())
            fail("the last cluster ends at {} of {} triangles in order", next,
                 clustering_.order.size());
        if (capsules != clustering_.capsule_count)
            fail("capsule_count is {}, there are {}", clustering_.capsule_count, capsules);
        for (std::size_t triangle = 0; triangle < uses_.size(); ++triangle) {
            const std::uint32_t uses = uses_[triangle];
            if (mesh_.degenerate(triangle)) {
                if (uses > 0) fail("triangle {}: degenerate, yet in a cluster", triangle);
            } else if (uses != 1) {
                fail("triangle {}: in {} clusters", triangle, uses);
            }
        }
        return take_lines();
    }

  private:
    void check_form(std::size_t c, const Cluster& cluster) {
        if (cluster.count < 1 || cluster.count > config_.max_triangles)
            fail("cluster {}: {} triangles instead of 1 to {}", c, cluster.count,
                 config_.max_triangles);
        if (!config_.capsules && cluster.a != cluster.b)
            fail("cluster {}: a capsule where balls were asked for", c);
        if (!(cluster.cone_cosine >= -1 && cluster.cone_cosine <= 1))
            fail("cluster {}: cone_cosine {}", c, cluster.cone_cosine);
        const float length = glm::length(cluster.axis);
        if (!(std::abs(length - 1) <= 1e-5f)) fail("cluster {}: an axis of length {}", c, length);
    }

    /// Comparisons are written so that NaN fails them.
    void check_triangles(std::size_t c, const Cluster& cluster) {
        const std::uint64_t end = std::uint64_t{cluster.first} + cluster.count;
        if (end > clustering_.order.size()) {
            fail("cluster {}: range {} to {} exceeds the {} triangles in order", c, cluster.first,
                 end, clustering_.order.size());
            return;
        }
        const glm::dvec3 axis = cluster.axis;
        for (std::uint64_t i = cluster.first; i < end; ++i) {
            const std::uint32_t triangle = clustering_.order[i];
            if (triangle >= mesh_.triangle_count()) {
                fail("cluster {}: triangle {} of {} does not exist", c, triangle,
                     mesh_.triangle_count());
                continue;
            }
            ++uses_[triangle];
            if (mesh_.degenerate(triangle)) continue;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 corner = mesh_.corner(triangle, k);
                if (!(distance_to_axis(cluster, corner) <= cluster.radius))
                    fail("cluster {}: corner {} of triangle {} is {} from the axis, the radius {}",
                         c, k, triangle, distance_to_axis(cluster, corner), cluster.radius);
                const double along = glm::dot(axis, corner);
                if (!(along >= cluster.slab_low && along <= cluster.slab_high))
                    fail("cluster {}: corner {} of triangle {} is at {}, the slab from {} to {}", c,
                         k, triangle, along, cluster.slab_low, cluster.slab_high);
            }
            if (cluster.cone_cosine == -1) continue;
            const glm::dvec3 normal = normal_of(mesh_, triangle);
            const double cosine =
                glm::dot(normal, axis) / (glm::length(normal) * glm::length(axis));
            if (!(cosine >= cluster.cone_cosine))
                fail("cluster {}: the normal of triangle {} has cosine {}, the cone {}", c,
                     triangle, cosine, cluster.cone_cosine);
        }
    }

    const geometry::TriangleMesh& mesh_;
    const Clustering& clustering_;
    const ClusterConfig& config_;
    std::vector<std::uint32_t> uses_;  ///< by triangle
};

}  // namespace

std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Clustering& clustering,
                                  const ClusterConfig& config) {
    return Validator(mesh, clustering, config).run();
}

}  // namespace structures::metric_tree
