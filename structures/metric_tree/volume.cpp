// Ball or capsule by the extents along the principal axes of the corners; all in double precision,
// relative to the corners' mean, until the result is rounded.
#include "structures/metric_tree/volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "structures/metric_tree/rounding.hpp"

namespace structures::metric_tree {
namespace {

using geometry::TriangleMesh;
using glm::dmat3;
using glm::dvec3;

constexpr double kSpare = 4 * 0x1p-24;
/// A capsule where the corners reach this much farther along their first axis than their second.
constexpr double kLongish = 2;

/// A ball with all points of its support on its surface, and the directions they span.
struct Ball {
    dvec3 center{0};
    double square = -1;  ///< of the radius; nothing is in the ball of no support
    dvec3 first{0};      ///< a point of the support
    std::array<dvec3, 3> spanned;
    int support_count = 0, spanned_count = 0;

    bool holds(const dvec3& point) const {
        const dvec3 away = point - center;
        return glm::dot(away, away) <= square * (1 + 1e-12);
    }

    /// The smallest ball with one more point on its surface: the center moves across what is
    /// spanned so far, away from all of the support alike. Ignores a point that spans nothing new.
    Ball through(const dvec3& point) const {
        Ball ball = *this;
        if (ball.support_count++ == 0) {
            ball.center = ball.first = point;
            ball.square = 0;
            return ball;
        }
        const dvec3 edge = point - first;
        dvec3 across = edge;
        for (int i = 0; i < spanned_count; ++i)
            across -= spanned[i] * (glm::dot(spanned[i], edge) / glm::dot(spanned[i], spanned[i]));
        const double height = glm::dot(across, across);
        if (!(height > 1e-20 * glm::dot(edge, edge))) return ball;
        const dvec3 away = point - center;
        const double move = (glm::dot(away, away) - square) / (2 * height);
        ball.center += move * across;
        ball.square += move * move * height;
        ball.spanned[ball.spanned_count++] = across;
        return ball;
    }
};

/// The smallest ball around the points with `support` on its surface; a disc if `dimension` is 2
/// and the points share a plane. E. Welzl, "Smallest enclosing disks (balls and ellipsoids)", 1991,
/// with points moved to the front. Roundings may leave points outside.
Ball smallest_ball(std::span<dvec3> points, int dimension, const Ball& support = {}) {
    Ball ball = support;
    if (support.support_count > dimension) return ball;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (ball.holds(points[i])) continue;
        ball = smallest_ball(points.first(i), dimension, support.through(points[i]));
        std::rotate(points.begin(), points.begin() + i, points.begin() + i + 1);
    }
    return ball;
}

/// Eigenvectors of a symmetric matrix, by Jacobi's rotations; the greatest eigenvalue's first.
dmat3 eigenvectors(dmat3 matrix) {
    dmat3 axes(1);
    for (int sweep = 0; sweep < 16; ++sweep) {
        const double rest =
            std::abs(matrix[0][1]) + std::abs(matrix[0][2]) + std::abs(matrix[1][2]);
        if (rest <= 1e-14 * (matrix[0][0] + matrix[1][1] + matrix[2][2])) break;
        for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
            if (matrix[p][q] == 0) continue;
            const double theta = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
            const double tangent =
                std::copysign(1, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
            const double cosine = 1 / std::sqrt(tangent * tangent + 1), sine = tangent * cosine;
            dmat3 turn(1);
            turn[p][p] = turn[q][q] = cosine;
            turn[q][p] = sine;
            turn[p][q] = -sine;
            matrix = glm::transpose(turn) * matrix * turn;
            axes = axes * turn;
        }
    }
    std::array<int, 3> rank{0, 1, 2};
    std::stable_sort(rank.begin(), rank.end(),
                     [&](int i, int j) { return matrix[i][i] > matrix[j][j]; });
    return {axes[rank[0]], axes[rank[1]], axes[rank[2]]};
}

/// Each once, as far as their indices tell.
struct Corners {
    std::vector<glm::vec3> exact;
    dvec3 mean{0};
    std::vector<dvec3> places;  ///< relative to the mean
    dmat3 axes;                 ///< principal ones

    Corners(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
        std::vector<std::uint32_t> used;
        used.reserve(3 * triangles.size());
        for (const std::uint32_t triangle : triangles)
            for (int k = 0; k < 3; ++k) used.push_back(mesh.triangles[triangle][k]);
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        places.reserve(used.size());
        exact.reserve(used.size());
        for (const std::uint32_t position : used) {
            exact.push_back(mesh.positions[position]);
            places.push_back(exact.back());
            mean += places.back();
        }
        mean /= static_cast<double>(places.size());
        dmat3 covariance(0);
        for (dvec3& place : places) {
            place -= mean;
            covariance += glm::outerProduct(place, place);
        }
        axes = eigenvectors(covariance);
    }

    std::pair<double, double> range_along(const dvec3& axis) const {
        std::pair range{std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
        for (const dvec3& place : places) {
            const double along = glm::dot(axis, place);
            range = {std::min(range.first, along), std::max(range.second, along)};
        }
        return range;
    }
    double extent_along(const dvec3& axis) const {
        const auto [low, high] = range_along(axis);
        return high - low;
    }
};

using Segment = std::pair<dvec3, dvec3>;

/// Axis of the smallest ball, or of the ball around the middle of the box should that be smaller:
/// whatever the roundings, the result is no worse than a box's.
Segment ball_axis(const Corners& corners) {
    std::vector<dvec3> points = corners.places;
    const Ball ball = smallest_ball(points, 3);
    dvec3 lower = points[0], upper = points[0];
    for (const dvec3& point : points)
        lower = glm::min(lower, point), upper = glm::max(upper, point);
    const auto reach = [&](const dvec3& center) {
        double square = 0;
        for (const dvec3& point : points)
            square = std::max(square, glm::dot(point - center, point - center));
        return square;
    };
    const dvec3 middle = 0.5 * (lower + upper);
    const dvec3 center = reach(ball.center) <= reach(middle) ? ball.center : middle;
    return {center, center};
}

/// The axis passes through the smallest disc around the corners seen along the first axis. A corner
/// at place t along it and d away from it is in the capsule if an end is no more than sqrt(r^2 -
/// d^2) short of t: the ends lie as far in as all corners allow.
Segment capsule_axis(const Corners& corners) {
    const dmat3& axes = corners.axes;
    std::vector<dvec3> seen;
    seen.reserve(corners.places.size());
    for (const dvec3& place : corners.places)
        seen.emplace_back(glm::dot(axes[1], place), glm::dot(axes[2], place), 0);
    std::vector<dvec3> points = seen;
    const Ball disc = smallest_ball(points, 2);
    double begin = std::numeric_limits<double>::infinity(), end = -begin;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const dvec3 away = seen[i] - disc.center;
        const double spare = std::sqrt(std::max(0.0, disc.square - glm::dot(away, away)));
        const double along = glm::dot(axes[0], corners.places[i]);
        begin = std::min(begin, along + spare);
        end = std::max(end, along - spare);
    }
    if (!(begin < end)) return ball_axis(corners);
    const dvec3 through = disc.center.x * axes[1] + disc.center.y * axes[2];
    return {through + begin * axes[0], through + end * axes[0]};
}

double largest_coordinate(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Axis, and cosine rounded down, of a cone around the normals; the thinnest axis and -1 if there
/// is none narrower than 180 degrees.
void fit_cone(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
              const dvec3& thinnest, Cluster& cluster) {
    cluster.axis = thinnest;
    cluster.cone_cosine = -1;
    dvec3 sum(0);
    for (const std::uint32_t triangle : triangles) sum += glm::normalize(normal_of(mesh, triangle));
    const double length = glm::length(sum);
    if (!(length > 1e-6 * static_cast<double>(triangles.size()))) return;
    const glm::vec3 axis = sum / length;
    double cosine = 1;
    for (const std::uint32_t triangle : triangles) {
        const dvec3 from = mesh.corner(triangle, 0), normal = normal_of(mesh, triangle);
        // What rounding turns the normal by, at most, much for a sliver, and its cosine by no more.
        const double error = 16 * 0x1p-53 * glm::distance(from, dvec3(mesh.corner(triangle, 1))) *
                             glm::distance(from, dvec3(mesh.corner(triangle, 2)));
        cosine =
            std::min(cosine, (glm::dot(normal, dvec3(axis)) / glm::length(dvec3(axis)) - error) /
                                 glm::length(normal));
    }
    const float rounded = rounded_down(cosine);
    if (!(rounded > 0)) return;
    cluster.axis = axis;
    cluster.cone_cosine = rounded;
}

}  // namespace

glm::dvec3 normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const dvec3 a = mesh.corner(triangle, 0), b = mesh.corner(triangle, 1),
                c = mesh.corner(triangle, 2);
    return glm::cross(b - a, c - a);
}

double distance_to_axis(const Cluster& cluster, const glm::dvec3& point) {
    const dvec3 a = cluster.a, along = dvec3(cluster.b) - a, away = point - a;
    const double square = glm::dot(along, along);
    const double t = square > 0 ? glm::clamp(glm::dot(away, along) / square, 0.0, 1.0) : 0.0;
    return glm::length(away - t * along);
}

Cluster fit_volume(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                   bool capsules) {
    const Corners corners(mesh, triangles);
    const dmat3& axes = corners.axes;
    std::array extents{corners.extent_along(axes[0]), corners.extent_along(axes[1]),
                       corners.extent_along(axes[2])};
    const bool longish = capsules && extents[0] >= kLongish * std::max(extents[1], extents[2]);
    const Segment axis = longish ? capsule_axis(corners) : ball_axis(corners);

    Cluster cluster{};
    cluster.a = axis.first + corners.mean;
    cluster.b = axis.second + corners.mean;
    cluster.count = static_cast<std::uint32_t>(triangles.size());
    fit_cone(mesh, triangles, axes[2], cluster);

    // Only now that axis and ends are rounded: how far the corners are.
    const dvec3 direction = cluster.axis;
    double reach = 0, low = std::numeric_limits<double>::infinity(), high = -low, farthest = 0,
           largest = std::max(largest_coordinate(cluster.a), largest_coordinate(cluster.b));
    for (const dvec3 corner : corners.exact) {
        const double along = glm::dot(direction, corner);
        reach = std::max(reach, distance_to_axis(cluster, corner));
        low = std::min(low, along);
        high = std::max(high, along);
        farthest = std::max(farthest, glm::length(corner));
        largest = std::max(largest, largest_coordinate(corner));
    }
    const double spare = kSpare * farthest * glm::length(direction);
    cluster.radius = rounded_up(reach + kSpare * largest);
    cluster.slab_low = rounded_down(low - spare);
    cluster.slab_high = rounded_up(high + spare);
    return cluster;
}

}  // namespace structures::metric_tree
