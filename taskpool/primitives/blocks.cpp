#include "taskpool/primitives/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "taskpool/primitives/range.hpp"

namespace taskpool::primitives {
namespace {

constexpr std::uint64_t ceil_divide(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

}  // namespace

Blocks cut(std::uint32_t elements, std::uint32_t step, std::uint32_t min_iterations) {
    // Enough to fill any device; more only where a block's loop would grow too long.
    constexpr std::uint64_t kUsualBlocks = 4096, kMostBlocks = 65535, kMaxIterations = 30'000;
    if (elements == 0) return {};
    const std::uint64_t steps = ceil_divide(elements, step);
    const std::uint64_t usual = std::min(ceil_divide(steps, min_iterations), kUsualBlocks);
    const std::uint64_t wanted =
        std::min(std::max(usual, ceil_divide(steps, kMaxIterations)), kMostBlocks);
    const std::uint64_t length = ceil_divide(steps, wanted) * step;
    return {std::uint32_t(ceil_divide(elements, length)), std::uint32_t(length)};
}

void require(const Range& range, std::size_t bytes, const char* what) {
    if (range.bytes < bytes)
        throw std::invalid_argument(
            fmt::format("{} holds {} bytes, {} are needed", what, range.bytes, bytes));
}

}  // namespace taskpool::primitives
