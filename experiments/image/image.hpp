// A plain float image, and its files.
//
//     Image image(1920, 1080, 3);              // linear RGB, all 0
//     image.at(x, y, 0) = 0.5f;
//     write_exr("out.exr", image, {{"R", "G", "B"}});
//     write_png("out.png", image);
//
// Every function that touches a file throws FileError, one line: the path, what failed and why.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace experiments::image {

/// what() is "PATH: message", one line.
struct FileError : std::runtime_error {
    FileError(const std::filesystem::path& file, const std::string& message)
        : std::runtime_error(file.string() + ": " + message), path(file) {}
    std::filesystem::path path;
};

/// Rows from the top, pixels from the left, the channels of a pixel side by side.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> values;

    Image() = default;
    Image(int columns, int rows, int channel_count, float value = 0)
        : width(columns),
          height(rows),
          channels(channel_count),
          values(std::size_t(columns) * rows * channel_count, value) {}
    float& at(int x, int y, int c) { return values[index(x, y, c)]; }
    float at(int x, int y, int c) const { return values[index(x, y, c)]; }
    bool operator==(const Image&) const = default;

  private:
    std::size_t index(int x, int y, int c) const {
        return (std::size_t(y) * width + x) * channels + c;
    }
};

/// 32-bit float channels, ZIP compressed, one name per channel ("R", "visibility", ...). Throws
/// std::invalid_argument for an empty image, or names that are not one per channel and distinct.
void write_exr(const std::filesystem::path& path, const Image& image,
               std::span<const std::string> channel_names);

struct NamedImage {
    Image image;
    std::vector<std::string> channel_names;  ///< sorted, as OpenEXR files keep them
};
/// Every channel of a single-part scan-line or tiled file, converted to float.
NamedImage read_exr(const std::filesystem::path& path);

/// 8 bits per channel, sRGB-encoded from linear values clamped to [0, 1] (NaN: 0); 1 channel (grey)
/// or 3 (RGB), else std::invalid_argument.
void write_png(const std::filesystem::path& path, const Image& image);
/// Linear values of a PNG as grey (1 channel) or RGB (3 channels); alpha is dropped onto black.
Image read_png(const std::filesystem::path& path);

/// Writes all bytes or throws FileError (folder missing or read-only, disk full, ...), leaving no
/// partial regular file behind.
void write_file(const std::filesystem::path& path, std::span<const char> bytes);

/// sRGB transfer function (IEC 61966-2-1) and its inverse.
float srgb_encode(float linear);
float srgb_decode(float encoded);

}  // namespace experiments::image
