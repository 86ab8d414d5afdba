// End-point overlap of a BVH: how much surface lies in boxes it does not belong to.
//
//     double epo = end_point_overlap(mesh, tree, {});
#pragma once

#include "structures/bvh/tree.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace structures::bvh {

/// EPO of Aila, Karras and Laine 2013, "On quality metrics of bounding volume hierarchies", section
/// 4: the sum over all nodes n of C(n) * area((S \ Q(n)) clipped to n's box) / area(S), where S are
/// the scene's surfaces, Q(n) those in n's subtree, and C(n) = `traversal` for inner nodes and
/// `intersection` times the primitives for leaves. Surfaces count once per triangle, boxes are
/// closed: a triangle in the face of a neighbour's box overlaps it. Computed exactly but for
/// rounding, by clipping in double precision; independent of the number of threads.
/// 0 for an empty tree. `tree` must be valid.
double end_point_overlap(const geometry::TriangleMesh& mesh, const Tree& tree,
                         const CostModel& costs);

/// Area of the part of triangle `corners` that lies in the closed `box`.
double clipped_area(const glm::dvec3 (&corners)[3], const geometry::Aabb& box);

}  // namespace structures::bvh
