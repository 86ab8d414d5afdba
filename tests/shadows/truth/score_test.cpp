// Counting errors on masks drawn by hand.
#include "shadows/truth/score.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace shadows;
using namespace shadows::truth;

struct Drawing {
    std::uint32_t width, height;
    Verdicts verdicts;
    Visibility visible;
};

/// One character per pixel. Right answers: '.' lit, '#' shadowed. Wrong ones: 'L' shadowed but
/// called lit, 'S' lit but called shadowed; 'a' 'b' 'c' as L, but within 1, 4, 16 epsilon; 'F' as
/// L, facing away; 'A' both; 'f' right, facing away; 'x' right, within 1 epsilon; ' ' background.
Drawing draw(const std::vector<std::string>& rows) {
    Drawing d{std::uint32_t(rows[0].size()), std::uint32_t(rows.size()), {}, {}};
    const std::uint32_t tiles = (d.width + 15) / 16 * ((d.height + 15) / 16);
    d.verdicts.points.resize(tiles * kTilePoints);
    d.visible.words.assign(tiles * kTilePoints / 32, ~0u);
    const auto bits_of = [](char c) -> int {
        constexpr int k16 = Verdict::kWithin16, k4 = k16 | Verdict::kWithin4,
                      k1 = k4 | Verdict::kWithin1;
        constexpr int shadowed = Verdict::kGeometry | Verdict::kShadowed;
        switch (c) {
            case ' ':
                return 0;
            case '#':
            case 'L':
                return shadowed;
            case 'a':
                return shadowed | k1;
            case 'b':
                return shadowed | k4;
            case 'c':
                return shadowed | k16;
            case 'F':
                return shadowed | Verdict::kFacingAway;
            case 'A':
                return shadowed | Verdict::kFacingAway | k1;
            case 'f':
                return Verdict::kGeometry | Verdict::kFacingAway;
            case 'x':
                return Verdict::kGeometry | k1;
            default:
                return Verdict::kGeometry;
        }
    };
    for (std::uint32_t y = 0; y < d.height; ++y)
        for (std::uint32_t x = 0; x < d.width; ++x) {
            const std::uint32_t i = point_index(x, y, d.width);
            const char c = rows[y][x];
            d.verdicts.points[i].bits = static_cast<std::uint8_t>(bits_of(c));
            if (c == '#' || c == 'S') d.visible.words[i / 32] &= ~(1u << (i % 32));
        }
    return d;
}

Score score(const Drawing& d) { return score_answer(d.verdicts, d.visible, d.width, d.height); }

TEST(Score, CountsEachKindOfPoint) {
    const Score s = score(draw({"..##LLL ", "SSaxbcff", "FFFA.###"}));
    EXPECT_EQ(s.points, 23u);
    EXPECT_EQ(s.facing_away, 6u);
    EXPECT_EQ(s.facing_away_errors, 3u);
    EXPECT_EQ(s.ambiguous, 2u);
    EXPECT_EQ(s.false_lit, 5u) << "three, and two that are ambiguous within 4 and 16 epsilon only";
    EXPECT_EQ(s.false_shadowed, 2u);
    EXPECT_EQ(s.disagreeing, (std::array<std::uint32_t, 3>{1, 2, 3}));
}

TEST(Score, RightAnswersHaveNoErrors) {
    const Score s = score(draw({"..##xf  ", "##......"}));
    EXPECT_EQ(s.points, 14u);
    EXPECT_EQ(s.false_lit + s.false_shadowed + s.leaks + s.leak_largest + s.facing_away_errors, 0u);
    EXPECT_EQ(s.disagreeing, (std::array<std::uint32_t, 3>{}));
}

TEST(Score, JoinsLeaksBySidesAndCorners) {
    const Score s = score(draw({"LL...L", "..L...", "L....L", ".....L", "S.SLaL"}));
    EXPECT_EQ(s.leaks, 5u);
    EXPECT_EQ(s.leak_largest, 3u);
    EXPECT_EQ(s.false_lit, 9u);
}

TEST(Score, LeaksCrossTilesAndDoNotWrapAround) {
    std::vector<std::string> rows(20, std::string(37, '.'));
    rows[15][15] = rows[16][16] = rows[15][17] = 'L';  // across the corner of four tiles
    rows[3][36] = rows[4][0] = 'L';                    // the end of a row and the next one's start
    const Score s = score(draw(rows));
    EXPECT_EQ(s.leaks, 3u);
    EXPECT_EQ(s.leak_largest, 3u);
}

TEST(Score, MaskShowsErrorsInPlace) {
    const std::vector<std::string> rows{"L.S ", "aF#f"};
    const Drawing d = draw(rows);
    const std::vector<Error> expected{Error::false_lit, Error::none,    Error::false_shadowed,
                                      Error::none,      Error::in_band, Error::none,
                                      Error::none,      Error::none};
    EXPECT_EQ(error_mask(d.verdicts, d.visible, d.width, d.height), expected);
}

TEST(Score, RefusesAnotherImagesAnswer) {
    Drawing d = draw({"...", "..."});
    EXPECT_THROW(score_answer(d.verdicts, d.visible, 17, 2), std::invalid_argument);
    EXPECT_THROW(error_mask(d.verdicts, d.visible, 3, 17), std::invalid_argument);
    d.visible.words.pop_back();
    EXPECT_THROW(score_answer(d.verdicts, d.visible, 3, 2), std::invalid_argument);
    EXPECT_EQ(score_answer({}, {}, 0, 0).points, 0u);
}

}  // namespace
