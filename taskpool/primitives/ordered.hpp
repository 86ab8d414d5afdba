// Floats as words of the same order, as ordered.glsl makes them.
#pragma once

#include <bit>
#include <cstdint>

namespace taskpool::primitives {

/// Inverse of ordered() in ordered.glsl.
constexpr float from_ordered(std::uint32_t word) {
    return std::bit_cast<float>(word ^ (word & 0x80000000u ? 0x80000000u : 0xffffffffu));
}

}  // namespace taskpool::primitives
