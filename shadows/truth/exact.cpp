// The exact stage: inputs become integers by a common power of two. Everything that is not plain
// double precision stays in this file.
#include "shadows/truth/exact.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <initializer_list>

namespace shadows::truth {
namespace {

// Finite floats are multiples of 2^-149 below 2^128: 277 bits. A difference has 278, a product of
// three 834, the sum of six of them 837.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    1024, 1024, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

struct Vector {
    Integer x, y, z;
};

/// Exponent of the last bit of `value`'s 24-bit mantissa.
int last_bit(float value) {
    int exponent;
    std::frexp(value, &exponent);
    return exponent - 24;
}

/// The largest power of two (its exponent) of which all components are multiples.
int unit_of(std::initializer_list<glm::vec3> vectors) {
    int unit = 128;
    for (const glm::vec3& v : vectors)
        for (int i = 0; i < 3; ++i)
            if (v[i] != 0) unit = std::min(unit, last_bit(v[i]));
    return unit;
}

Integer lift(float value, int unit) {
    if (value == 0) return 0;
    int exponent;
    const float mantissa = std::frexp(value, &exponent);
    const Integer digits = static_cast<std::int32_t>(std::ldexp(mantissa, 24));
    return digits << (exponent - 24 - unit);
}

Vector lift(const glm::vec3& v, int unit) {
    return {lift(v.x, unit), lift(v.y, unit), lift(v.z, unit)};
}

Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

int sign_of_determinant(const Vector& a, const Vector& b, const Vector& c) {
    const Integer value = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                          a.z * (b.x * c.y - b.y * c.x);
    return value.sign();
}

}  // namespace

int exact_orientation(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 o) {
    const int unit = unit_of({a, b, c, o});
    const Vector origin = lift(o, unit);
    return sign_of_determinant(lift(a, unit) - origin, lift(b, unit) - origin,
                               lift(c, unit) - origin);
}

int exact_orientation_towards(glm::vec3 a, glm::vec3 b, glm::vec3 direction, glm::vec3 o) {
    const int unit = unit_of({a, b, o});
    const Vector origin = lift(o, unit);
    return sign_of_determinant(lift(a, unit) - origin, lift(b, unit) - origin,
                               lift(direction, unit_of({direction})));
}

}  // namespace shadows::truth
