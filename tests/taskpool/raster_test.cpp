// Rasterisation: images, pipelines and their options.
#include <gmock/gmock.h>

#include <algorithm>
#include <glm/glm.hpp>

#include "taskpool/gpu/recorder.hpp"
#include "tests/support/gpu_fixture.hpp"

std::span<const taskpool::gpu::Shader> tests_taskpool_raster_shaders();

namespace {

using namespace taskpool::gpu;
using Raster = tests::GpuTest;

constexpr std::uint32_t kWidth = 24, kHeight = 10, kNone = 99, kAdd = 5;

/// A triangle over the whole screen at one depth; clockwise or counter-clockwise on the screen.
std::vector<glm::vec4> covering(float depth, bool clockwise = false) {
    std::vector<glm::vec4> corners{{-1, -1, depth, 1}, {-1, 3, depth, 1}, {3, -1, depth, 1}};
    if (clockwise) std::swap(corners[1], corners[2]);
    return corners;
}

struct Picture {
    std::vector<std::uint32_t> ids;
    std::vector<float> depths;
};

RasterOptions with_depth() {
    RasterOptions options;
    options.color_formats = {VK_FORMAT_R32_UINT};
    options.depth_format = VK_FORMAT_D32_SFLOAT;
    options.constants = {{1, kAdd}};
    return options;
}

Picture draw(const std::vector<glm::vec4>& corners, const RasterOptions& options) {
    Device& device = tests::device();
    const auto shader = [](const char* path) -> const Shader& {
        return find_shader(tests_taskpool_raster_shaders(), path);
    };
    const RasterPipeline pipeline(device, shader("tests/taskpool/triangles.vert"),
                                  shader("tests/taskpool/triangles.frag"), options);
    const Image ids(device, VK_FORMAT_R32_UINT, kWidth, kHeight, "ids");
    const Image depth(device, options.depth_format, kWidth, kHeight, "depth");
    const std::size_t pixels = kWidth * kHeight;
    const Buffer data = make_buffer<glm::vec4>(device, corners, "corners");
    const Buffer id_words(device, pixels * 4, "id words"), depths(device, pixels * 4, "depths");
    RenderTargets targets;
    targets.colors.push_back({&ids, {.uint32 = {kNone}}});
    targets.depth = &depth;
    Recorder recorder(device);
    for (int twice = 0; twice < 2; ++twice) {  // targets can be used again in one recording
        recorder.begin_rendering("triangles", targets);
        recorder.draw(pipeline, data.address(), std::uint32_t(corners.size()));
        recorder.end_rendering();
        recorder.copy(ids, VK_IMAGE_ASPECT_COLOR_BIT, id_words);
        recorder.copy(depth, VK_IMAGE_ASPECT_DEPTH_BIT, depths);
        recorder.barrier();
    }
    device.run(recorder);
    return {read<std::uint32_t>(id_words, pixels), read<float>(depths, pixels)};
}

TEST_F(Raster, NothingDrawnIsCleared) {
    const Picture picture = draw({}, with_depth());
    EXPECT_THAT(picture.ids, testing::Each(kNone));
    EXPECT_THAT(picture.depths, testing::Each(0.f));
}

TEST_F(Raster, TheNearestTriangleWinsWithReversedDepth) {
    std::vector<glm::vec4> corners;
    for (float depth : {0.25f, 0.75f, 0.5f})
        for (const glm::vec4& corner : covering(depth)) corners.push_back(corner);
    const Picture picture = draw(corners, with_depth());
    EXPECT_THAT(picture.ids, testing::Each(1 + kAdd));
    EXPECT_THAT(picture.depths, testing::Each(0.75f));
}

TEST_F(Raster, RowsStartAtTheTop) {
    // The left half of the upper half.
    const std::vector<glm::vec4> corners{{-1, -1, 0.5f, 1}, {-1, 0, 0.5f, 1}, {0, -1, 0.5f, 1},
                                         {0, 0, 0.5f, 1},   {-1, 0, 0.5f, 1}, {0, -1, 0.5f, 1}};
    const Picture picture = draw(corners, with_depth());
    for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x)
            EXPECT_EQ(picture.ids[y * kWidth + x] != kNone, x < kWidth / 2 && y < kHeight / 2);
}

TEST_F(Raster, CullingDropsOneOrientation) {
    RasterOptions options = with_depth();
    options.cull = VK_CULL_MODE_BACK_BIT;
    const bool counter = draw(covering(0.5f, false), options).ids[0] != kNone;
    const bool clockwise = draw(covering(0.5f, true), options).ids[0] != kNone;
    EXPECT_NE(counter, clockwise);
    options.cull = VK_CULL_MODE_FRONT_BIT;
    EXPECT_NE(draw(covering(0.5f, false), options).ids[0] != kNone, counter);
}

TEST_F(Raster, DepthClampKeepsWhatClippingDrops) {
    RasterOptions options = with_depth();
    EXPECT_THAT(draw(covering(1.5f), options).ids, testing::Each(kNone));
    options.depth_clamp = true;
    const Picture picture = draw(covering(1.5f), options);
    EXPECT_THAT(picture.ids, testing::Each(kAdd));
    EXPECT_THAT(picture.depths, testing::Each(1.f));
}

TEST_F(Raster, DepthBiasShiftsDepth) {
    RasterOptions options = with_depth();
    options.depth_bias_constant = -1000;
    const Picture picture = draw(covering(0.5f), options);
    for (float depth : picture.depths) {
        EXPECT_LT(depth, 0.5f);
        EXPECT_GT(depth, 0.49f);
    }
}

TEST_F(Raster, ImagesAreCountedAndCheckSizes) {
    Device& device = tests::device();
    const std::uint64_t before = device.allocated_bytes();
    {
        Image image(device, VK_FORMAT_R32_UINT, 64, 64, "counted");
        const Image moved = std::move(image);
        EXPECT_GE(device.allocated_bytes(), before + 64 * 64 * 4);
    }
    EXPECT_EQ(device.allocated_bytes(), before);
    EXPECT_THROW(Image(device, VK_FORMAT_R32_UINT, 0, 1, "flat"), std::invalid_argument);
    try {
        const Image huge(device, VK_FORMAT_R32_UINT, 1u << 30, 1, "huge");
        FAIL() << "an image of 2^30 columns was made";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("'huge'"));
    }
    EXPECT_EQ(device.allocated_bytes(), before);
}

}  // namespace
