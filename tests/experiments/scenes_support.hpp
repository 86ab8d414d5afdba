// Helpers of the scene tests: a folder of their own, files in it, and what every loaded mesh holds.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/scenes/mesh_file.hpp"

namespace experiments::scenes {

class SceneFiles : public testing::Test {
  protected:
    SceneFiles() {
        std::string pattern = (std::filesystem::temp_directory_path() / "scenes.XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~SceneFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        const std::filesystem::path path = folder_ / name;
        std::filesystem::remove(path);  // truncating in place waits for the disk on some systems
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    /// Loads `bytes` as a file of this name.
    LoadedMesh load(const std::string& name, const std::string& bytes) const {
        return load_mesh(write(name, bytes));
    }

    /// The message with which loading fails; it must be one line that starts with the path.
    std::string error(const std::string& name, const std::string& bytes) const {
        return error_at(write(name, bytes));
    }
    std::string error_at(const std::filesystem::path& path) const {
        try {
            load_mesh(path);
        } catch (const LoadError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.find('\n'), message.npos) << message;
            EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
            EXPECT_EQ(error.path, path);
            return message;
        }
        ADD_FAILURE() << path << " loads";
        return {};
    }

    std::filesystem::path folder_;
};

inline std::string gzipped(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, bytes.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

/// What load_mesh guarantees of any mesh it returns.
inline void expect_guarantees(const LoadedMesh& scene) {
    const auto& [mesh, report] = scene;
    ASSERT_GT(mesh.triangle_count(), 0u);
    EXPECT_EQ(report.triangles, mesh.triangle_count());
    EXPECT_EQ(report.vertices, mesh.positions.size());
    EXPECT_LE(report.degenerate, report.triangles);
    EXPECT_LT(report.duplicates, report.triangles);
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) ASSERT_LT(t[k], mesh.positions.size());
    for (const glm::vec3 p : mesh.positions)
        for (int k = 0; k < 3; ++k) ASSERT_LE(std::abs(p[k]), kMaxCoordinate);
}

/// The bytes of `values`, one after the other, in the host's order or swapped.
template <typename T>
std::string raw(std::initializer_list<T> values, bool swapped = false) {
    std::string bytes;
    for (const T value : values) {
        std::string one(reinterpret_cast<const char*>(&value), sizeof value);
        if (swapped) one.assign(one.rbegin(), one.rend());
        bytes += one;
    }
    return bytes;
}

}  // namespace experiments::scenes
