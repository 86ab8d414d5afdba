// From double to single precision in the direction that keeps a bound a bound.
#pragma once

#include <cmath>
#include <limits>

namespace structures::metric_tree {

inline float rounded_up(double x) {
    const auto f = static_cast<float>(x);
    return f < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

inline float rounded_down(double x) {
    const auto f = static_cast<float>(x);
    return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

}  // namespace structures::metric_tree
