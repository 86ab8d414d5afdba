// The points of a shadow query, as a G-buffer gives them, and the bits that answer it.
//
// Order. An image is cut into tiles of 16 x 16 pixels, row by row of tiles; within a tile into
// blocks of 4 x 4, row by row; within a block into an upper and a lower half of 4 x 2, row by row.
// So any 8, 16 or 256 consecutive, aligned points are neighbours on the screen: what a packet, a
// subgroup or a beam loads is contiguous. Images whose sides are no multiple of 16 are padded with
// points without geometry.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "taskpool/gpu/buffer.hpp"

namespace shadows {

inline constexpr std::uint32_t kTileSide = 16;
inline constexpr std::uint32_t kTilePoints = kTileSide * kTileSide;
/// Primitive id of a point without geometry (background, padding).
inline constexpr std::uint32_t kNoPrimitive = 0xffffffffu;
/// Primitive id of a point in free space: it is asked about, and no triangle is its own.
inline constexpr std::uint32_t kNoReceiver = 0xfffffffeu;

/// Place of pixel (x, y) in the point order of an image `width` pixels wide.
constexpr std::uint32_t point_index(std::uint32_t x, std::uint32_t y, std::uint32_t width) {
    const std::uint32_t tiles_x = (width + kTileSide - 1) / kTileSide;
    const std::uint32_t tile = (y / kTileSide) * tiles_x + x / kTileSide;
    const std::uint32_t block = (y % kTileSide / 4) * 4 + x % kTileSide / 4;
    return tile * kTilePoints + block * 16 + (y % 4) * 4 + x % 4;
}

/// Structure of arrays, on the host and on the device. Positions are world space, fp32, exact as
/// every method sees them; a point without geometry sits at the origin.
struct PointArrays {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> primitive;
    std::vector<glm::vec3> normal;  ///< geometric normal of the primitive, towards the viewer
};

class Points {
  public:
    /// Uploads `arrays` (all of one length, padded to whole tiles). Throws std::invalid_argument if
    /// a length differs or is no multiple of kTilePoints.
    Points(taskpool::gpu::Device& device, PointArrays arrays, std::uint32_t width,
           std::uint32_t height);

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    /// Padded number of points; a multiple of kTilePoints.
    std::uint32_t count() const { return static_cast<std::uint32_t>(host_.x.size()); }
    /// Points with geometry.
    std::uint32_t valid_count() const { return valid_count_; }
    const PointArrays& host() const { return host_; }
    /// Device address of four planes of `count()` words each: x, y, z, primitive.
    std::uint64_t address() const { return device_.address(); }

  private:
    PointArrays host_;
    taskpool::gpu::Buffer device_;
    std::uint32_t width_ = 0, height_ = 0, valid_count_ = 0;
};

/// One bit per point; see Method::query.
struct Visibility {
    std::vector<std::uint32_t> words;
    bool lit(std::uint32_t point) const { return words[point / 32] >> (point % 32) & 1u; }
};

}  // namespace shadows
