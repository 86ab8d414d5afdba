// Catmull-Rom splines (E. Catmull and R. Rom, "A class of local interpolating splines", 1974): a
// smooth curve through all its knots.
//
//     SplinePoint<glm::dvec3> middle = on_spline<glm::dvec3>(knots, 1.5);   // between 1 and 2
#pragma once

#include <algorithm>
#include <span>

namespace experiments::scenes {

template <typename Vector>
struct SplinePoint {
    Vector point;
    Vector slope;  ///< a multiple of the derivative
};

/// Where the curve is at parameter `at`, from 0 (the first of two knots or more) to the last one's
/// index. It goes on straight at both ends.
template <typename Vector>
SplinePoint<Vector> on_spline(std::span<const Vector> knots, double at) {
    const std::size_t last = knots.size() - 1;
    const std::size_t i = std::min(static_cast<std::size_t>(at), last - 1);
    const double t = at - static_cast<double>(i);
    const Vector b = knots[i], c = knots[i + 1];
    const Vector a = i > 0 ? knots[i - 1] : 2.0 * b - c;
    const Vector d = i + 1 < last ? knots[i + 2] : 2.0 * c - b;
    const Vector linear = c - a, square = 2.0 * a - 5.0 * b + 4.0 * c - d;
    const Vector cube = 3.0 * (b - c) + d - a;
    return {b + 0.5 * t * (linear + t * (square + t * cube)),
            linear + t * (2.0 * square + 3.0 * t * cube)};
}

}  // namespace experiments::scenes
