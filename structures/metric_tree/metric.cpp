// Frames, distances and elements in double precision. The formulas of distances are metric.glsl's.
#include "structures/metric_tree/metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "structures/metric_tree/rounding.hpp"

namespace structures::metric_tree {
namespace {

using glm::dvec3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

/// Power of two that takes `size` to between 1 and 2, within what single precision can multiply by.
float scale_of(double size) {
    if (!(size > 0 && size < kInfinity)) return 1;
    return static_cast<float>(std::ldexp(1.0, -std::clamp(std::ilogb(size), -126, 126)));
}

double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

LightFrame make_point_frame(const dvec3& origin, const geometry::Aabb& bounds) {
    LightFrame frame{};
    frame.origin = origin;
    frame.scale = 1;
    frame.right = {1, 0, 0}, frame.up = {0, 1, 0}, frame.forward = {0, 0, 1};
    frame.delta = std::numbers::pi_v<float>;
    if (bounds.empty()) return frame;
    const dvec3 lower = dvec3(bounds.lower) - origin, upper = dvec3(bounds.upper) - origin;
    frame.scale = scale_of(largest(glm::max(glm::abs(lower), glm::abs(upper))));
    const double away = glm::length(0.5 * (lower + upper));
    const double radius = 0.5 * glm::length(upper - lower);
    if (away > radius) frame.delta = rounded_up(std::asin(radius / away));
    return frame;
}

LightFrame make_directional_frame(const dvec3& direction, const geometry::Aabb& bounds) {
    const double length = glm::length(direction);
    if (!(length > 0 && length < kInfinity))
        throw std::invalid_argument(
            "metric tree: a directional light needs a direction of finite length above 0");
    LightFrame frame{};
    frame.directional = 1;
    frame.scale = 1;
    const dvec3 forward = direction / length, size = glm::abs(forward);
    const dvec3 aside = size.x <= std::min(size.y, size.z) ? dvec3(1, 0, 0)
                        : size.y <= size.z                 ? dvec3(0, 1, 0)
                                                           : dvec3(0, 0, 1);
    const dvec3 right = glm::normalize(glm::cross(forward, aside));
    frame.forward = forward;
    frame.right = right;
    frame.up = glm::cross(forward, right);
    frame.start = 1;
    if (bounds.empty()) return frame;
    frame.origin = bounds.center();
    const dvec3 lower = dvec3(bounds.lower) - dvec3(frame.origin);
    const dvec3 upper = dvec3(bounds.upper) - dvec3(frame.origin);
    const dvec3 half = glm::max(glm::abs(lower), glm::abs(upper));
    frame.scale = scale_of(largest(half));
    frame.delta = rounded_up(glm::length(half) * frame.scale);
    // An eighth: a depth inside the box is no small difference of large numbers.
    frame.start = rounded_up(1.125 * frame.delta + 0.125);
    return frame;
}

dvec3 relative(const LightFrame& frame, const dvec3& point) {
    return (point - dvec3(frame.origin)) * double{frame.scale};
}

/// From the origin to the segment ab.
double distance_to_segment(const dvec3& a, const dvec3& b) {
    const dvec3 e = b - a;
    const double ee = glm::dot(e, e);
    const double t = ee > 0 ? std::clamp(-glm::dot(a, e) / ee, 0.0, 1.0) : 0.0;
    return glm::length(a + t * e);
}

double angle_between(const dvec3& p, const dvec3& q) {
    return std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
}

/// Whether all normals of the cluster are less than 90 degrees from all ways that light takes to
/// it. Normals point out of a closed mesh, so that these triangles are where light would leave
/// it: what they shadow is shadowed by those where it enters.
bool all_face_away(const LightFrame& frame, const Cluster& cluster, const Element& element) {
    if (!(cluster.cone_cosine > 0)) return false;
    const dvec3 axis = cluster.axis;
    // Between ends that are both less than 90 degrees from the axis no direction of an arc is
    // farther from it than they are.
    const double light = frame.directional != 0 ? angle_between(axis, frame.forward) + kMetricError
                                                : std::max(angle_between(axis, element.a),
                                                           angle_between(axis, element.b)) +
                                                      element.radius;
    const double cone = std::acos(std::min(double{cluster.cone_cosine}, 1.0)) + kMetricError;
    return light + cone < 0.5 * std::numbers::pi;
}

}  // namespace

LightFrame make_frame(const geometry::Light& light, const geometry::Aabb& bounds) {
    return light.type == geometry::Light::Type::point
               ? make_point_frame(light.vector, bounds)
               : make_directional_frame(light.vector, bounds);
}

dvec3 seen(const LightFrame& frame, const dvec3& point) {
    const dvec3 p = relative(frame, point);
    if (frame.directional == 0) return p;
    return {glm::dot(dvec3(frame.right), p), glm::dot(dvec3(frame.up), p), 0};
}

double depth_of(const LightFrame& frame, const dvec3& point) {
    const dvec3 p = relative(frame, point);
    if (frame.directional == 0) return glm::length(p);
    return glm::dot(dvec3(frame.forward), p) + frame.start;
}

double distance_between(bool directional, const dvec3& p, const dvec3& q) {
    return directional ? glm::length(p - q) : angle_between(p, q);
}

double distance_to(bool directional, const dvec3& p, const Element& element) {
    const dvec3 &a = element.a, &b = element.b;
    const dvec3 e = b - a;
    const double ee = glm::dot(e, e);
    if (!(ee > 0)) return distance_between(directional, p, a);
    double t;
    if (directional) {
        t = std::clamp(glm::dot(p - a, e) / ee, 0.0, 1.0);
    } else {
        const double ae = glm::dot(a, e), pa = glm::dot(p, a), pe = glm::dot(p, e);
        const double den = pa * ee - pe * ae;
        if (den > 0) {
            t = std::clamp((pe * glm::dot(a, a) - pa * ae) / den, 0.0, 1.0);
        } else {
            const double at_a = glm::length(glm::cross(p, a)), at_b = glm::length(glm::cross(p, b));
            t = glm::dot(p, b) * at_a > pa * at_b ? 1.0 : 0.0;
        }
    }
    return distance_between(directional, p, a + t * e);
}

Reach reach_of(bool directional, const Element& pivot, const Element& element) {
    Reach reach;
    reach.middle = distance_to(directional, 0.5 * (element.a + element.b), pivot);
    reach.low = reach.high = reach.middle;
    if (element.a != element.b) {
        const double half_length = 0.5 * distance_between(directional, element.a, element.b);
        const double at_a = distance_to(directional, element.a, pivot);
        const double at_b = distance_to(directional, element.b, pivot);
        reach.low = 0.5 * (reach.middle + std::min(at_a, at_b) - half_length);
        reach.high = 0.5 * (reach.middle + std::max(at_a, at_b) + half_length);
    }
    reach.low = std::max(reach.low - (element.radius + kMetricError), 0.0);
    reach.high += element.radius + kMetricError;
    return reach;
}

Role make_element(const LightFrame& frame, const Cluster& cluster, bool cull_facing,
                  Element& element, double& min_depth) {
    const double radius = double{cluster.radius} * frame.scale;
    const double shrunk = 1 - 0x1p-20;
    element.a = seen(frame, cluster.a);
    element.b = seen(frame, cluster.b);
    if (frame.directional != 0) {
        const double nearest =
            std::min(depth_of(frame, cluster.a), depth_of(frame, cluster.b)) - radius;
        min_depth = std::max(0.0, (nearest - kMetricError) * shrunk);
        element.radius = radius + kMetricError;
    } else {
        const double away = distance_to_segment(element.a, element.b);
        min_depth = std::max(0.0, (away - radius) * shrunk);
        // Also where a coordinate is not finite.
        if (!(away > radius * (1 + 0x1p-10)) || !(glm::dot(element.a, element.b) >= 0))
            return Role::special;
        // Each point X of ab contributes the cone of half angle asin(radius / |X|) around a
        // direction of the arc.
        element.radius =
            std::atan2(radius, std::sqrt((away - radius) * (away + radius))) + kMetricError;
        if (!(element.radius <= kWidestElement)) return Role::special;
        element.a = glm::normalize(element.a);
        element.b = glm::normalize(element.b);
    }
    return cull_facing && all_face_away(frame, cluster, element) ? Role::faces_away : Role::element;
}

MetricNode make_node(const Element& element, double min_depth) {
    MetricNode node{};
    node.a = element.a;
    node.b = element.b;
    node.radius = rounded_up(element.radius);
    node.near_max = -1;
    node.min_depth = rounded_down(min_depth);
    node.over_min = kFloatInfinity;
    node.over_max = 0;
    node.far_min = kFloatInfinity;
    return node;
}

MetricNode special_node(std::uint32_t next) {
    MetricNode node{};
    node.a = node.b = {1, 0, 0};
    node.radius = kFloatInfinity;
    node.near_max = -1;
    node.over = next;
    node.over_max = kFloatInfinity;
    node.far_min = kFloatInfinity;
    return node;
}

Element element_of(const MetricNode& node) { return {node.a, node.b, node.radius}; }

}  // namespace structures::metric_tree
