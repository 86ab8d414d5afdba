// PNG files through libpng's simplified interface, encoded and decoded in memory.
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "experiments/image/image.hpp"

namespace experiments::image {
namespace {

/// png_image that frees what libpng hangs onto it.
struct PngImage : png_image {
    PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(this); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

}  // namespace

float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

void write_png(const std::filesystem::path& path, const Image& image) {
    if (image.width <= 0 || image.height <= 0 || (image.channels != 1 && image.channels != 3))
        throw std::invalid_argument(
            fmt::format("write_png: {} x {} pixels of {} channels; expected 1 or 3 channels",
                        image.width, image.height, image.channels));
    std::vector<png_byte> pixels(image.values.size());
    std::transform(image.values.begin(), image.values.end(), pixels.begin(), [](float value) {
        const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN too becomes 0
        return static_cast<png_byte>(std::lround(255 * srgb_encode(clamped)));
    });
    PngImage png;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = image.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
    std::vector<char> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, nullptr))
        throw FileError(path, fmt::format("cannot be encoded as PNG: {}", png.message));
    write_file(path, std::span(bytes).first(size));
}

Image read_png(const std::filesystem::path& path) {
    PngImage png;
    if (!png_image_begin_read_from_file(&png, path.c_str()))
        throw FileError(path, fmt::format("cannot be read as PNG: {}", png.message));
    png.format = png.format & PNG_FORMAT_FLAG_COLOR ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
    const png_color black = {0, 0, 0};
    std::vector<png_byte> pixels(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, &black, pixels.data(), 0, nullptr))
        throw FileError(path, fmt::format("cannot be read as PNG: {}", png.message));
    Image image(static_cast<int>(png.width), static_cast<int>(png.height),
                static_cast<int>(PNG_IMAGE_SAMPLE_CHANNELS(png.format)));
    std::transform(pixels.begin(), pixels.end(), image.values.begin(),
                   [](png_byte value) { return srgb_decode(value / 255.0f); });
    return image;
}

}  // namespace experiments::image
