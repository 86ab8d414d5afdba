// The readers behind load_mesh, one per format. They see a whole file as bytes, append to `mesh`
// and `report` (polygons and skipped only), and throw FormatError for what they cannot read;
// load_mesh puts the path in front.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/scenes/mesh_file.hpp"

namespace experiments::scenes {

/// A fault inside a file; what() has the place, not the path.
struct FormatError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void read_ply(std::string_view bytes, LoadedMesh& scene);
void read_obj(std::string_view bytes, LoadedMesh& scene);
/// `.gltf` and `.glb` alike (told apart by the first bytes). Buffers of their own are looked up in
/// `folder`.
void read_gltf(std::string_view bytes, const std::filesystem::path& folder, LoadedMesh& scene);

/// The whole file, decompressed if `gzipped`. Throws FormatError, or LoadError's causes in words.
std::string read_bytes(const std::filesystem::path& path, bool gzipped);

/// Appends the n - 2 triangles of a polygon to the mesh and counts it: one triangle as it is, a
/// convex polygon as a fan around its first corner, any other by clipping ears. Faces of less than
/// three corners are counted as skipped. `corners` must be in range.
void add_polygon(std::span<const std::uint32_t> corners, LoadedMesh& scene);

/// Parses a decimal number at `text`, rounded once to a float ("nan" and "inf" included; beyond the
/// range: infinity or 0). Returns the end of the number, or nullptr if there is none.
const char* parse_float(const char* text, const char* end, float& value);

}  // namespace experiments::scenes
