#include "shadows/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace shadows {
namespace {

/// `arrays` if consistent with the image; throws std::invalid_argument naming what is wrong.
PointArrays checked(PointArrays arrays, std::uint32_t width, std::uint32_t height) {
    const auto tiles = [](std::uint32_t side) {
        return (std::uint64_t{side} + kTileSide - 1) / kTileSide;
    };
    const std::size_t expected = tiles(width) * tiles(height) * kTilePoints;
    const auto check = [&](const char* name, std::size_t size) {
        if (size != expected)
            throw std::invalid_argument(
                fmt::format("Points: {} has {} entries; {} x {} pixels padded to whole tiles of "
                            "{} x {} need {}",
                            name, size, width, height, kTileSide, kTileSide, expected));
    };
    check("x", arrays.x.size());
    check("y", arrays.y.size());
    check("z", arrays.z.size());
    check("primitive", arrays.primitive.size());
    check("normal", arrays.normal.size());
    return arrays;
}

}  // namespace

Points::Points(taskpool::gpu::Device& device, PointArrays arrays, std::uint32_t width,
               std::uint32_t height)
    : host_(checked(std::move(arrays), width, height)),
      device_(device, std::size_t{count()} * 4 * sizeof(float), "points"),
      width_(width),
      height_(height),
      valid_count_(static_cast<std::uint32_t>(
          std::count_if(host_.primitive.begin(), host_.primitive.end(),
                        [](std::uint32_t id) { return id != kNoPrimitive; }))) {
    const std::size_t plane = std::size_t{count()} * sizeof(float);
    device_.write(host_.x.data(), plane, 0);
    device_.write(host_.y.data(), plane, plane);
    device_.write(host_.z.data(), plane, 2 * plane);
    device_.write(host_.primitive.data(), plane, 3 * plane);
}

}  // namespace shadows
