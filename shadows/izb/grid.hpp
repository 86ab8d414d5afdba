// The grid of an irregular z-buffer: how many cells each face gets, and where they lie.
//
//     IzbFrame frame = make_frame(bounds, light);              // origin, scale, axes
//     ... extents of the points, on the device ...
//     Grid grid = make_grid(frame, extents, resolution);       // the faces
#pragma once

#include <cstdint>

#include "shadows/izb/izb_shared.h"
#include "structures/geometry/aabb.hpp"
#include "structures/geometry/light.hpp"

namespace shadows::izb {

/// Cells along a face's longer side at most.
inline constexpr std::uint32_t kMaxResolution = 1u << (kLevels - 1);

/// The frame for a mesh within `bounds` (not empty); its faces are left empty.
IzbFrame make_frame(const structures::geometry::Aabb& bounds,
                    const structures::geometry::Light& light);

struct Grid {
    IzbFrame frame;
    std::uint32_t cell_count = 0;  ///< of all faces
    std::uint32_t node_count = 0;  ///< of all faces' pyramids, cells included
};

/// Levels of a face's pyramid, cells included: 0 if it has no points.
std::uint32_t level_count(const IzbFace& face);
/// Nodes of one of these levels.
std::uint32_t level_nodes(const IzbFace& face, std::uint32_t level);

/// Cells for the faces that have points: `resolution`, rounded up to a power of two, along the
/// longer side, or as many as give a cell kPointsPerCell points on average if it is 0.
Grid make_grid(const IzbFrame& frame, const IzbExtents& extents, std::uint32_t resolution);
inline constexpr double kPointsPerCell = 8;

}  // namespace shadows::izb
