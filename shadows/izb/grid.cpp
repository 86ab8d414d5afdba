#include "shadows/izb/grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "taskpool/primitives/ordered.hpp"

namespace shadows::izb {
namespace {

using structures::geometry::Aabb;
using structures::geometry::Light;
using taskpool::primitives::from_ordered;

/// The power of two that takes `size` to between 1 and 2, or next to that where it has none.
float scale_for(float size) {
    const std::uint32_t exponent =
        std::clamp(std::bit_cast<std::uint32_t>(size) >> 23 & 0xffu, 1u, 253u);
    return std::bit_cast<float>((254u - exponent) << 23);
}

int dominant_axis(glm::vec3 v) {
    const glm::vec3 size = glm::abs(v);
    return size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
}

float largest(glm::vec3 v) { return std::max({v.x, v.y, v.z}); }

/// Base-two logarithms of a face's cells across and down.
glm::uvec2 log_cells(const IzbFace& face, glm::dvec2 extent, std::uint32_t resolution) {
    // A side no longer than a few roundings of its ends gets a single cell.
    const auto thin = [&](int i) {
        const double reach = std::max(std::abs(face.lower[i]), std::abs(face.upper[i]));
        return !(extent[i] > 1e-30 && extent[i] > reach * 0x1p-20);
    };
    const double long_side = std::max(thin(0) ? 0 : extent.x, thin(1) ? 0 : extent.y);
    const glm::dvec2 share(thin(0) ? 0 : extent.x / long_side, thin(1) ? 0 : extent.y / long_side);
    double side = resolution;
    if (resolution == 0) {
        side = face.points / kPointsPerCell;
        if (share.x > 0 && share.y > 0) side = std::sqrt(side / (share.x * share.y));
    }
    const auto log = [&](double part) {
        const double exact = std::log2(std::max(side * part, 1.0));
        const double whole = resolution == 0 ? std::round(exact) : std::ceil(exact);
        return std::uint32_t(std::min(whole, double(kLevels - 1)));
    };
    return {log(share.x), log(share.y)};
}

void place_cells(IzbFace& face, std::uint32_t resolution) {
    const glm::dvec2 extent = glm::dvec2(face.upper) - glm::dvec2(face.lower);
    const glm::uvec2 logs = log_cells(face, extent, resolution);
    face.log_width = logs.x;
    face.log_height = logs.y;
    for (int i = 0; i < 2; ++i) {
        const double cells = double(1u << logs[i]);
        face.cell[i] = float(extent[i] / cells);
        face.cells_per_unit[i] = logs[i] == 0 ? 0.0f : float(cells / extent[i]);
        // A point's place in cells, (u - lower) * cells_per_unit, is off by three roundings of at
        // most 2^11 cells: 2^-11 cells. A cell's bound, lower + i * cell, by three of its terms.
        const double reach = std::max(std::abs(face.lower[i]), std::abs(face.upper[i]));
        face.pad[i] = float(extent[i] / cells * 0x1p-9 + (reach + extent[i]) * 0x1p-21);
    }
}

}  // namespace

IzbFrame make_frame(const Aabb& bounds, const Light& light) {
    IzbFrame frame{};
    if (light.type == Light::Type::directional) {
        const glm::vec3 towards = -light.vector;
        const int axis = dominant_axis(towards);
        frame.origin = 0.5f * bounds.lower + 0.5f * bounds.upper;
        frame.face = 2u * axis + (towards[axis] < 0 ? 1 : 0);
        frame.tilt = {towards[(axis + 1) % 3] / std::abs(towards[axis]),
                      towards[(axis + 2) % 3] / std::abs(towards[axis])};
    } else {
        frame.origin = light.vector;
    }
    frame.scale = scale_for(std::max(largest(glm::abs(bounds.lower - frame.origin)),
                                     largest(glm::abs(bounds.upper - frame.origin))));
    return frame;
}

std::uint32_t level_count(const IzbFace& face) {
    return face.points == 0 ? 0 : std::max(face.log_width, face.log_height) + 1;
}

std::uint32_t level_nodes(const IzbFace& face, std::uint32_t level) {
    return 1u << (std::max(face.log_width, level) - level + std::max(face.log_height, level) -
                  level);
}

Grid make_grid(const IzbFrame& frame, const IzbExtents& extents, std::uint32_t resolution) {
    Grid grid{frame};
    for (std::uint32_t f = 0; f < kFaces; ++f) {
        IzbFace& face = grid.frame.faces[f];
        face = {};
        const IzbExtent& extent = extents.faces[f];
        face.points = extent.points;
        if (face.points == 0) continue;
        face.lower = {from_ordered(~extent.not_lower_u), from_ordered(~extent.not_lower_v)};
        face.upper = {from_ordered(extent.upper_u), from_ordered(extent.upper_v)};
        face.reach = from_ordered(extent.reach);
        place_cells(face, resolution);
        face.level_first[0] = grid.cell_count;
        grid.cell_count += level_nodes(face, 0);
    }
    grid.node_count = grid.cell_count;
    for (IzbFace& face : grid.frame.faces)
        for (std::uint32_t level = 1; level < level_count(face); ++level) {
            face.level_first[level] = grid.node_count;
            grid.node_count += level_nodes(face, level);
        }
    return grid;
}

}  // namespace shadows::izb
