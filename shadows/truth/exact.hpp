// Signs of determinants of single-precision inputs, without rounding.
//
//     Signs signs;
//     int side = orientation(a, b, c, o, signs);                // det(a - o, b - o, c - o)
//     int turn = orientation_towards(a, b, direction, o, signs);  // det(a - o, b - o, direction)
//
// A filter in double precision decides nearly all of them; integers decide the rest.
//
// The filter. Let e = 2^-53. A difference of two floats in double precision is rounded once: it is
// the true one times (1 + d), |d| <= e. Each of the six products of three differences that make up
// the determinant then carries at most eight such factors into the computed value: three of the
// differences, two of the multiplications, one of the subtraction inside the cross product, two of
// the additions of the dot product. Hence
//     |computed - true| <= ((1 + e)^8 - 1) P,
// where P is the sum of the six products' sizes. P is computed with the same number of factors, all
// on positive terms: computed P >= (1 - e)^8 P. So |computed - true| < 8.1 e P_computed, and
// 2^-49 P_computed = 16 e P_computed is a bound. Nothing underflows or overflows: differences are 0
// or within 2^-149 .. 2^129, subnormal inputs included, so products of three are normal doubles.
// For the same reason a computed P of 0 means that every product is 0, and so is the determinant.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace shadows::truth {

/// How many signs were decided by what.
struct Signs {
    std::uint64_t filtered = 0;
    std::uint64_t exact = 0;
};

/// The sign in integer arithmetic; -1, 0 or 1. Arguments must be finite.
int exact_orientation(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o);
int exact_orientation_towards(glm::vec3 a, glm::vec3 b, glm::vec3 direction, glm::vec3 o);

/// The filter: sign of det(a, b, c) if it can be vouched for, else kUnsure. The vectors' components
/// are off by a factor 1 + d each, |d| <= 2^-53.
inline constexpr int kUnsure = 2;
inline int filtered_sign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double yz = b.y * c.z, zy = b.z * c.y;
    const double zx = b.z * c.x, xz = b.x * c.z;
    const double xy = b.x * c.y, yx = b.y * c.x;
    const double value = a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx);
    const double size = std::abs(a.x) * (std::abs(yz) + std::abs(zy)) +
                        std::abs(a.y) * (std::abs(zx) + std::abs(xz)) +
                        std::abs(a.z) * (std::abs(xy) + std::abs(yx));
    const double bound = size * 0x1p-49;
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return size == 0 ? 0 : kUnsure;
}

/// Sign of det(a - o, b - o, c - o) = N . (a - o), where N = (b - a) x (c - a): positive if o lies
/// on the side of the plane that N points away from.
inline int orientation(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o, Signs& signs) {
    const glm::dvec3 origin(o);
    const int sign =
        filtered_sign(glm::dvec3(a) - origin, glm::dvec3(b) - origin, glm::dvec3(c) - origin);
    if (sign != kUnsure) {
        ++signs.filtered;
        return sign;
    }
    ++signs.exact;
    return exact_orientation(a, b, c, o);
}

/// Sign of det(a - o, b - o, direction).
inline int orientation_towards(glm::vec3 a, glm::vec3 b, glm::vec3 direction, glm::vec3 o,
                               Signs& signs) {
    const glm::dvec3 origin(o);
    const int sign =
        filtered_sign(glm::dvec3(a) - origin, glm::dvec3(b) - origin, glm::dvec3(direction));
    if (sign != kUnsure) {
        ++signs.filtered;
        return sign;
    }
    ++signs.exact;
    return exact_orientation_towards(a, b, direction, o);
}

}  // namespace shadows::truth
