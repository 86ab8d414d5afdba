// Distances between what the light sees, in double precision: metric.glsl for the CPU builders, and
// the exact bounds that trees are checked against.
#pragma once

#include <glm/glm.hpp>

#include "structures/geometry/aabb.hpp"
#include "structures/geometry/light.hpp"
#include "structures/metric_tree/metric_tree_shared.h"

namespace structures::metric_tree {

/// All directions (point light), or places across the light (directional), within `radius` of the
/// arc, or segment, from `a` to `b`.
struct Element {
    glm::dvec3 a, b;
    double radius;
};

/// Least and greatest distance of an element's points from a pivot's arc, errors included.
struct Reach {
    double low, high, middle;  ///< `middle`: to the middle of the element's arc, no error included
};

/// The frame of `light` for casters within `bounds`; an empty box is fine.
LightFrame make_frame(const geometry::Light& light, const geometry::Aabb& bounds);

/// Where the light sees the point: a direction of any length, or a place across the light.
glm::dvec3 seen(const LightFrame& frame, const glm::dvec3& point);
/// How far from the light, scaled: what MetricNode::min_depth is compared with.
double depth_of(const LightFrame& frame, const glm::dvec3& point);

double distance_between(bool directional, const glm::dvec3& p, const glm::dvec3& q);
double distance_to(bool directional, const glm::dvec3& p, const Element& element);
Reach reach_of(bool directional, const Element& pivot, const Element& element);

enum class Role {
    element,
    special,  ///< around or near the light, wider than kWidestElement, or an arc above 90 degrees
    faces_away,  ///< from the light, all of its triangles (only if asked to look)
};
/// What the cluster is to the light and, for an element, how it is seen, widened by kMetricError,
/// and its least depth, rounded down.
Role make_element(const LightFrame& frame, const Cluster& cluster, bool cull_facing,
                  Element& element, double& min_depth);
/// A node without subtrees.
MetricNode make_node(const Element& element, double min_depth);
/// The node of a special cluster, in front of the one that `next` links to (0: none).
MetricNode special_node(std::uint32_t next);
Element element_of(const MetricNode& node);

}  // namespace structures::metric_tree
