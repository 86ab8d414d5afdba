// Clusters of neighbouring triangles in balls and capsules, made once per mesh on the CPU.
//
//     Clustering clusters = cluster(mesh, {.max_triangles = 16});
//     assert(validate(mesh, clusters).empty());
//
// Triangles are sorted by the Morton code of their centroid and cut into chunks of 512; each chunk
// is split by k-means until no part has more than `max_triangles`. F. Deves et al., "Scalable
// Real-Time Shadows using Clustering and Metric Trees", 2018, section 4; what the paper leaves open
// is said in clustering.cpp. Degenerate triangles are left out. Chunks are independent and run in
// parallel; the result does not depend on how.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "structures/geometry/triangle_mesh.hpp"
#include "structures/metric_tree/metric_tree_shared.h"

namespace structures::metric_tree {

struct ClusterConfig {
    std::uint32_t max_triangles = 16;  ///< in a cluster, 1 to 64
    bool capsules = true;              ///< otherwise balls only
    std::uint64_t seed = 1;            ///< of k-means' first centres
};

struct Clustering {
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> order;  ///< triangles, cluster after cluster
    std::uint32_t capsule_count = 0;
};

/// Throw std::invalid_argument if max_triangles is out of range, or for 2^27 or more triangles.
void check(const ClusterConfig& config);
void check(const geometry::TriangleMesh& mesh);

std::uint32_t count_capsules(const std::vector<Cluster>& clusters);

/// `progress` gets the share done, from 0 to 1, from one thread at a time; it may be empty. Throws
/// what check() throws.
Clustering cluster(const geometry::TriangleMesh& mesh, const ClusterConfig& config,
                   const std::function<void(double)>& progress = {});

/// One line per violation: every triangle that is not degenerate in exactly one cluster; vertices
/// in the ball or capsule and in the slab; normals in the cone; sizes within the limit.
std::vector<std::string> validate(const geometry::TriangleMesh& mesh, const Clustering& clustering,
                                  const ClusterConfig& config);

}  // namespace structures::metric_tree
