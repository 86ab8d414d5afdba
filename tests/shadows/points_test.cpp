// The order of points, and their upload.
#include "shadows/points.hpp"

#include <gmock/gmock.h>

#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/points.hpp"

namespace shadows {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(PointOrder, IsABijectionOntoWholeTiles) {
    for (const auto& [width, height] :
         {std::pair{16u, 16u}, {64u, 32u}, {1u, 1u}, {17u, 5u}, {33u, 47u}, {1920u, 1080u}}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height);
        const std::uint32_t padded_width = (width + 15) / 16 * 16,
                            padded_height = (height + 15) / 16 * 16;
        std::vector<int> hits(std::size_t{padded_width} * padded_height);
        for (std::uint32_t y = 0; y < padded_height; ++y)
            for (std::uint32_t x = 0; x < padded_width; ++x) {
                const std::uint32_t i = point_index(x, y, width);
                ASSERT_LT(i, hits.size());
                ++hits[i];
            }
        EXPECT_THAT(hits, testing::Each(1));
    }
}

TEST(PointOrder, ConsecutivePointsAreNeighbours) {
    constexpr std::uint32_t kSide = 64;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::uint32_t i = point_index(x, y, kSide);
            // The first point of the aligned run of 8, 16 and 256 that holds this one.
            EXPECT_EQ(i / 8, point_index(x / 4 * 4, y / 2 * 2, kSide) / 8);
            EXPECT_EQ(i / 16, point_index(x / 4 * 4, y / 4 * 4, kSide) / 16);
            EXPECT_EQ(i / 256, point_index(x / 16 * 16, y / 16 * 16, kSide) / 256);
        }
}

using PointUpload = tests::GpuTest;

TEST_F(PointUpload, LaysOutFourPlanes) {
    const auto mesh = tests::random_triangles(20, 1);
    const PointArrays arrays = tests::random_points(mesh, 33, 18, 2);
    const Points points(tests::device(), arrays, 33, 18);
    EXPECT_EQ(points.width(), 33u);
    EXPECT_EQ(points.height(), 18u);
    ASSERT_EQ(points.count(), 6 * kTilePoints);
    EXPECT_NE(points.address(), 0u);
    EXPECT_EQ(points.valid_count(),
              points.count() -
                  std::count(arrays.primitive.begin(), arrays.primitive.end(), kNoPrimitive));
    EXPECT_GT(points.valid_count(), 400u);
    EXPECT_EQ(points.host().y, arrays.y);
}

TEST_F(PointUpload, AcceptsNoPixels) {
    const Points points(tests::device(), {}, 0, 0);
    EXPECT_EQ(points.count(), 0u);
    EXPECT_EQ(points.valid_count(), 0u);
}

TEST_F(PointUpload, NamesTheArrayOfWrongLength) {
    const PointArrays arrays = tests::random_points({}, 16, 16, 1);
    const auto upload = [&](const PointArrays& wrong, std::uint32_t width = 16) {
        return [&wrong, width] { Points(tests::device(), wrong, width, 16); };
    };
    PointArrays wrong = arrays;
    wrong.z.pop_back();
    EXPECT_THAT(upload(wrong), ThrowsMessage<std::invalid_argument>(HasSubstr("z has 255")));
    wrong = arrays;
    wrong.normal.clear();
    EXPECT_THAT(upload(wrong), ThrowsMessage<std::invalid_argument>(HasSubstr("normal has 0")));
    EXPECT_THAT(upload(arrays, 17), ThrowsMessage<std::invalid_argument>(HasSubstr("need 512")));
}

}  // namespace
}  // namespace shadows
