// How an array is cut into blocks, one per workgroup.
#pragma once

#include <cstdint>

#include "taskpool/gpu/device.hpp"

namespace taskpool::primitives {

struct Blocks {
    std::uint32_t count = 0;   ///< at least 1 unless the array is empty; at most 65535
    std::uint32_t length = 0;  ///< elements per block but the last; a multiple of the step
};

/// Cuts `elements` so that a workgroup, taking `step` elements per loop iteration, makes at least
/// `min_iterations` (a block must be worth its start) and never too many: a driver may cut loops
/// (DeviceInfo::loop_limit).
Blocks cut(std::uint32_t elements, std::uint32_t step, std::uint32_t min_iterations);

}  // namespace taskpool::primitives
