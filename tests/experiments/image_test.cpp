// Images: files there and back, files that cannot be written, colour maps.
#include "experiments/image/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "experiments/image/color_map.hpp"

namespace experiments::image {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ImageFiles : public testing::Test {
  protected:
    ImageFiles() {
        std::string pattern = (std::filesystem::temp_directory_path() / "images.XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~ImageFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

/// Values that differ everywhere, some special.
Image sample(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<float>(i) * 0.37f - 1000;
    image.values.front() = std::numeric_limits<float>::infinity();
    image.values.back() = 1e-40f;
    return image;
}

template <typename Action>
std::string message_of(const std::filesystem::path& path, Action action) {
    try {
        action();
    } catch (const FileError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
        EXPECT_EQ(message.find('\n'), message.npos) << message;
        return message;
    }
    ADD_FAILURE() << "no error";
    return {};
}

TEST_F(ImageFiles, OpenExrKeepsEveryBitAndName) {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {257, 130}}) {
        const std::vector<std::string> names = {"a", "b.x", "visibility"};
        const Image image = sample(width, height, 3);
        write_exr(folder_ / "a.exr", image, names);
        const NamedImage back = read_exr(folder_ / "a.exr");
        EXPECT_EQ(back.channel_names, names);
        EXPECT_EQ(back.image, image);
    }
}

TEST_F(ImageFiles, OpenExrSortsChannelsByName) {
    const Image image = sample(5, 4, 3);
    write_exr(folder_ / "a.exr", image, std::vector<std::string>{"R", "G", "B"});
    const NamedImage back = read_exr(folder_ / "a.exr");
    EXPECT_THAT(back.channel_names, ElementsAre("B", "G", "R"));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.image.at(4, 3, c), image.at(4, 3, 2 - c));
}

TEST_F(ImageFiles, PngIsSrgb) {
    Image image(256, 2, 3);
    for (int x = 0; x < 256; ++x)
        for (int c = 0; c < 3; ++c)
            image.at(x, c % 2, c) = srgb_decode(static_cast<float>(x) / 255);
    write_png(folder_ / "a.png", image);
    EXPECT_EQ(read_png(folder_ / "a.png"), image);

    Image gray(4, 1, 1);
    gray.values = {-1, 2, std::nanf(""), 0.5f};
    write_png(folder_ / "b.png", gray);
    const Image back = read_png(folder_ / "b.png");
    EXPECT_EQ(back.channels, 1);
    EXPECT_THAT(back.values, ElementsAre(0, 1, 0, srgb_decode(188 / 255.0f)));
}

TEST_F(ImageFiles, CannotBeWritten) {
    const Image image(8, 8, 1);
    const std::vector<std::string> names = {"Y"};
    const auto missing = folder_ / "none" / "a.exr";
    EXPECT_THAT(message_of(missing, [&] { write_exr(missing, image, names); }),
                HasSubstr("cannot be created: No such file or directory"));
    const std::filesystem::path full = "/dev/full";
    EXPECT_THAT(message_of(full, [&] { write_exr(full, image, names); }),
                HasSubstr("cannot be written: No space left on device"));
    EXPECT_THAT(message_of(full, [&] { write_png(full, image); }), HasSubstr("No space left"));
    const std::vector<char> many(1 << 20);
    EXPECT_THAT(message_of(full, [&] { write_file(full, many); }), HasSubstr("No space left"));
    EXPECT_TRUE(std::filesystem::exists(full));
    const auto folder = folder_ / "folder.png";
    std::filesystem::create_directory(folder);
    EXPECT_THAT(message_of(folder, [&] { write_png(folder, image); }), HasSubstr("Is a directory"));
    if (geteuid() != 0) {
        std::filesystem::permissions(folder, std::filesystem::perms::owner_read);
        const auto path = folder / "a.png";
        EXPECT_THAT(message_of(path, [&] { write_png(path, image); }),
                    HasSubstr("Permission denied"));
    }
}

TEST_F(ImageFiles, CannotBeRead) {
    const auto path = folder_ / "a";
    EXPECT_THAT(message_of(path, [&] { read_exr(path); }), HasSubstr("cannot be read as OpenEXR"));
    EXPECT_THAT(message_of(path, [&] { read_png(path); }), HasSubstr("cannot be read as PNG"));
    write_exr(path, sample(64, 64, 2), std::vector<std::string>{"a", "b"});
    EXPECT_THAT(message_of(path, [&] { read_png(path); }), HasSubstr("cannot be read as PNG"));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_THAT(message_of(path, [&] { read_exr(path); }), HasSubstr("cannot be read as OpenEXR"));
    write_png(path, Image(64, 64, 1));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_THAT(message_of(path, [&] { read_png(path); }), HasSubstr("cannot be read as PNG"));
}

TEST_F(ImageFiles, RefuseWhatIsNoImage) {
    const auto path = folder_ / "a";
    const auto names = [](std::initializer_list<const char*> list) {
        return std::vector<std::string>(list.begin(), list.end());
    };
    EXPECT_THROW(write_exr(path, Image(), names({})), std::invalid_argument);
    EXPECT_THROW(write_exr(path, Image(2, 2, 2), names({"a"})), std::invalid_argument);
    EXPECT_THROW(write_exr(path, Image(2, 2, 2), names({"a", "a"})), std::invalid_argument);
    EXPECT_THROW(write_png(path, Image(2, 2, 2)), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(path));
}

float luminance(glm::vec3 color) { return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

TEST(ColorMaps, AreOrderedByLightness) {
    for (int i = 0; i < 256; ++i) {
        const float t = i / 256.0f, next = (i + 1) / 256.0f;
        EXPECT_LT(luminance(heat_color(t)), luminance(heat_color(next))) << t;
        EXPECT_GT(luminance(signed_color(t)), luminance(signed_color(next))) << t;
        EXPECT_GT(luminance(signed_color(-t)), luminance(signed_color(-next))) << t;
        for (const glm::vec3 c : {heat_color(t), signed_color(t), signed_color(-t)})
            for (int k = 0; k < 3; ++k) EXPECT_TRUE(c[k] >= 0 && c[k] <= 1);
    }
    EXPECT_EQ(heat_color(-3), heat_color(0));
    EXPECT_EQ(heat_color(7), heat_color(1));
}

TEST(ColorMaps, StepsAreAboutEquallyLarge) {
    // Differences of sRGB-encoded values between neighbours: no jump, no flat stretch.
    for (int i = 0; i < 64; ++i) {
        const glm::vec3 a = heat_color(i / 64.0f), b = heat_color((i + 1) / 64.0f);
        float step = 0;
        for (int k = 0; k < 3; ++k) step += std::abs(srgb_encode(a[k]) - srgb_encode(b[k]));
        EXPECT_GT(step, 0.01f) << i;
        EXPECT_LT(step, 0.12f) << i;
    }
}

TEST(HeatImage, MapsTheRangeAndMarksWhatIsNotANumber) {
    const float values[] = {-5, 0, 5, 10, 99, std::nanf("")};
    const Image image = heat_image(values, 3, 2, 0, 10);
    const auto pixel = [&](int x, int y) {
        return glm::vec3(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
    };
    EXPECT_EQ(pixel(0, 0), heat_color(0));
    EXPECT_EQ(pixel(1, 0), heat_color(0));
    EXPECT_LT(glm::distance(pixel(2, 0), heat_color(0.5f)), 0.01f);
    EXPECT_EQ(pixel(0, 1), heat_color(1));
    EXPECT_EQ(pixel(1, 1), heat_color(1));
    EXPECT_EQ(pixel(2, 1), glm::vec3(0, 1, 0));
    EXPECT_THROW(heat_image(values, 4, 2, 0, 10), std::invalid_argument);
    EXPECT_THROW(heat_image(values, 3, 2, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace experiments::image
