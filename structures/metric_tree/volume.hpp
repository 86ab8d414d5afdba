// The volume of a cluster: ball or capsule, slab and cone of normals around some triangles.
//
//     Cluster cluster = fit_volume(mesh, triangles, true);
//     distance_to_axis(cluster, corner) <= cluster.radius;  // for every corner of the triangles
//
// After Deves et al. 2018, section 4, but with capsules no longer than they need to be, and with
// everything rounded outwards.
#pragma once

#include <span>

#include "structures/geometry/triangle_mesh.hpp"
#include "structures/metric_tree/metric_tree_shared.h"

namespace structures::metric_tree {

/// Encloses the triangles, none of them degenerate and at least one. `first` is 0. Without
/// `capsules` the volume is a ball. Cost: linear in the corners, expected.
///
/// Radius and slab have 4 * 2^-24 of the largest coordinate to spare, so that evaluating them in
/// single precision loses nothing.
Cluster fit_volume(const geometry::TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                   bool capsules);

/// From the point to the cluster's segment ab, or to a where that is all.
double distance_to_axis(const Cluster& cluster, const glm::dvec3& point);

/// Across the triangle, as long as twice its area, in the turn of its corners.
glm::dvec3 normal_of(const geometry::TriangleMesh& mesh, std::uint32_t triangle);

}  // namespace structures::metric_tree
