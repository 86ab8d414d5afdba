// Loads a triangle mesh from a file: .ply (ASCII, binary little and big endian), .obj, .gltf, .glb,
// each also gzipped (.ply.gz, ...).
//
//     LoadedMesh scene = load_mesh("sponza.ply.gz");
//     fmt::print("{} triangles, {} degenerate", scene.report.triangles, scene.report.degenerate);
//
// Positions and triangles come in the file's order and nothing is merged or dropped: none of these
// formats forces a vertex per face corner, so a seam in a file is a seam in the mesh. A mesh that
// is returned has at least one triangle, indices in range and coordinates within +-kMaxCoordinate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "experiments/scenes/load_error.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace experiments::scenes {

/// Larger coordinates are refused: their squares, and so lengths and areas, overflow a float.
inline constexpr float kMaxCoordinate = 1e18f;

struct LoadReport {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::size_t degenerate = 0;  ///< triangles with no area (TriangleMesh::degenerate); kept
    std::size_t duplicates = 0;  ///< triangles on the same three points as an earlier one; kept
    std::size_t polygons = 0;    ///< faces of more than three corners, cut into triangles
    std::size_t skipped = 0;     ///< points, lines, faces below three corners, curves: left out
    bool operator==(const LoadReport&) const = default;
};

struct LoadedMesh {
    structures::geometry::TriangleMesh mesh;
    LoadReport report;
};

/// The extensions load_mesh knows, without the ".gz" that each may carry.
std::span<const std::string_view> mesh_extensions();

/// Throws LoadError if the file is missing, of an unknown kind, malformed, truncated, without a
/// triangle, or breaks one of the guarantees above.
LoadedMesh load_mesh(const std::filesystem::path& path);

/// Counts vertices, triangles, degenerate and duplicate triangles of any mesh (the other counts are
/// 0). Two triangles are duplicates if their corners are the same three points, bit by bit, in any
/// order.
LoadReport count(const structures::geometry::TriangleMesh& mesh);

}  // namespace experiments::scenes
