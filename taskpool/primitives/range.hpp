// Where a primitive finds its input and puts its output: part of a device buffer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "taskpool/gpu/buffer.hpp"

namespace taskpool::primitives {

/// `bytes` bytes from device address `address` on, a multiple of 4. A whole buffer converts.
struct Range {
    std::uint64_t address = 0;
    std::size_t bytes = 0;

    Range() = default;
    Range(std::uint64_t first, std::size_t size) : address(first), bytes(size) {}
    Range(const gpu::Buffer& buffer) : address(buffer.address()), bytes(buffer.size()) {}
    /// What is left after the first `offset` bytes (at most all).
    Range from(std::size_t offset) const {
        return {address + offset, bytes > offset ? bytes - offset : 0};
    }
    bool operator==(const Range&) const = default;
};

/// Throws std::invalid_argument naming `what` unless `range` holds `bytes`.
void require(const Range& range, std::size_t bytes, const char* what);

}  // namespace taskpool::primitives
