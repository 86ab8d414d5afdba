// load_mesh: picks the reader, then checks and counts what it read.
#include "experiments/scenes/mesh_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using structures::geometry::TriangleMesh;

constexpr std::array<std::string_view, 4> kExtensions = {".ply", ".obj", ".gltf", ".glb"};

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

/// The guarantees of a loaded mesh that no reader checks on its own.
void check(const TriangleMesh& mesh) {
    constexpr std::size_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
    if (mesh.triangles.empty())
        throw FormatError(
            fmt::format("has no triangles ({} vertices); is it a mesh?", mesh.positions.size()));
    if (mesh.positions.size() >= kMaxCount || mesh.triangles.size() >= kMaxCount)
        throw FormatError(fmt::format("has {} vertices and {} triangles; at most {} of each fit",
                                      mesh.positions.size(), mesh.triangles.size(), kMaxCount - 1));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const float value = mesh.positions[i][axis];
            if (std::abs(value) <= kMaxCoordinate) continue;  // false for NaN too
            if (!std::isfinite(value))
                throw FormatError(
                    fmt::format("vertex {} (counted from 0) has {} as its {} coordinate", i, value,
                                "xyz"[axis]));
            throw FormatError(
                fmt::format("vertex {} (counted from 0) has {} as its {} coordinate, beyond +-{}: "
                            "scale the mesh "
                            "down",
                            i, value, "xyz"[axis], kMaxCoordinate));
        }
}

/// The triangle's corners as bit patterns, smallest first: equal for duplicates.
std::array<std::uint32_t, 9> corner_bits(const TriangleMesh& mesh, std::size_t triangle) {
    std::array<std::array<std::uint32_t, 3>, 3> corners;
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 p = mesh.corner(triangle, k);
        corners[k] = {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                      std::bit_cast<std::uint32_t>(p.z)};
    }
    std::sort(corners.begin(), corners.end());
    return std::bit_cast<std::array<std::uint32_t, 9>>(corners);
}

/// How many triangles repeat an earlier one: only those whose hash occurs twice are compared.
std::size_t count_duplicates(const TriangleMesh& mesh) {
    struct Entry {
        std::uint64_t hash;
        std::uint32_t triangle;
    };
    std::vector<Entry> entries(mesh.triangle_count());
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        std::uint64_t hash = 0;
        for (const std::uint32_t word : corner_bits(mesh, i)) {
            hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        entries[i] = {hash, i};
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.hash < b.hash; });

    std::size_t duplicates = 0;
    std::vector<std::array<std::uint32_t, 9>> same;
    for (std::size_t first = 0, last; first < entries.size(); first = last) {
        last = first + 1;
        while (last < entries.size() && entries[last].hash == entries[first].hash) ++last;
        if (last - first == 1) continue;
        same.clear();
        for (std::size_t i = first; i < last; ++i)
            same.push_back(corner_bits(mesh, entries[i].triangle));
        std::sort(same.begin(), same.end());
        for (std::size_t i = 1; i < same.size(); ++i) duplicates += same[i] == same[i - 1];
    }
    return duplicates;
}

LoadedMesh read(const std::filesystem::path& path) {
    std::string extension = lower_case(path.extension().string());
    const bool gzipped = extension == ".gz";
    if (gzipped) extension = lower_case(path.stem().extension().string());
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
        throw FormatError(fmt::format("unknown kind of mesh file; known: {}, each also with .gz",
                                      fmt::join(kExtensions, " ")));

    const std::string bytes = read_bytes(path, gzipped);
    LoadedMesh scene;
    if (extension == ".ply")
        read_ply(bytes, scene);
    else if (extension == ".obj")
        read_obj(bytes, scene);
    else
        read_gltf(bytes, path.parent_path(), scene);
    check(scene.mesh);

    const LoadReport counts = count(scene.mesh);
    scene.report.vertices = counts.vertices;
    scene.report.triangles = counts.triangles;
    scene.report.degenerate = counts.degenerate;
    scene.report.duplicates = counts.duplicates;
    return scene;
}

}  // namespace

std::span<const std::string_view> mesh_extensions() { return kExtensions; }

LoadedMesh load_mesh(const std::filesystem::path& path) {
    try {
        return read(path);
    } catch (const FormatError& error) {
        throw LoadError(path, error.what());
    } catch (const std::bad_alloc&) {
        throw LoadError(path, "not enough memory to load it");
    } catch (const std::length_error&) {
        throw LoadError(path, "not enough memory to load it");
    }
}

LoadReport count(const TriangleMesh& mesh) {
    LoadReport report;
    report.vertices = mesh.positions.size();
    report.triangles = mesh.triangle_count();
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) report.degenerate += mesh.degenerate(i);
    report.duplicates = count_duplicates(mesh);
    return report;
}

}  // namespace experiments::scenes
