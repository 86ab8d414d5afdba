// Counts and clusters of errors; what counts as which error is decided in one place, error_of().
#include "shadows/truth/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace shadows::truth {
namespace {

void check(const Verdicts& verdicts, const Visibility& visible, std::uint32_t width,
           std::uint32_t height, const char* who) {
    const auto tiles = [](std::uint32_t side) {
        return (std::uint64_t{side} + kTileSide - 1) / kTileSide;
    };
    const std::uint64_t expected = tiles(width) * tiles(height) * kTilePoints;
    if (verdicts.points.size() != expected || visible.words.size() != expected / 32)
        throw std::invalid_argument(fmt::format(
            "{}: {} verdicts and {} words of answers; {} x {} pixels need {} and {}", who,
            verdicts.points.size(), visible.words.size(), width, height, expected, expected / 32));
}

/// What the point counts as; the facing-away ones count as no error.
Error error_of(const Verdict& verdict, bool lit) {
    const bool wrong = verdict.geometry() && verdict.shadowed() == lit;
    if (!wrong || verdict.facing_away()) return Error::none;
    if (verdict.ambiguous()) return Error::in_band;
    return lit ? Error::false_lit : Error::false_shadowed;
}

/// Sizes of the groups of false-lit pixels that touch by sides or corners.
std::vector<std::uint32_t> leak_sizes(std::vector<Error> mask, std::uint32_t width,
                                      std::uint32_t height) {
    std::vector<std::uint32_t> sizes, open;
    for (std::uint32_t start = 0; start < mask.size(); ++start) {
        if (mask[start] != Error::false_lit) continue;
        sizes.push_back(0);
        open.push_back(start);
        mask[start] = Error::none;
        while (!open.empty()) {
            const std::uint32_t x = open.back() % width, y = open.back() / width;
            open.pop_back();
            ++sizes.back();
            for (std::uint32_t ny = y - (y > 0); ny <= std::min(y + 1, height - 1); ++ny)
                for (std::uint32_t nx = x - (x > 0); nx <= std::min(x + 1, width - 1); ++nx) {
                    Error& neighbour = mask[ny * width + nx];
                    if (neighbour != Error::false_lit) continue;
                    neighbour = Error::none;
                    open.push_back(ny * width + nx);
                }
        }
    }
    return sizes;
}

}  // namespace

std::vector<Error> error_mask(const Verdicts& verdicts, const Visibility& visible,
                              std::uint32_t width, std::uint32_t height) {
    check(verdicts, visible, width, height, "error_mask");
    std::vector<Error> mask(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t i = point_index(x, y, width);
            mask[std::size_t{y} * width + x] = error_of(verdicts.points[i], visible.lit(i));
        }
    return mask;
}

Score score_answer(const Verdicts& verdicts, const Visibility& visible, std::uint32_t width,
                   std::uint32_t height) {
    check(verdicts, visible, width, height, "score_answer");
    Score score;
    for (std::uint32_t i = 0; i < verdicts.points.size(); ++i) {
        const Verdict verdict = verdicts.points[i];
        if (!verdict.geometry()) continue;
        ++score.points;
        const bool wrong = verdict.shadowed() == visible.lit(i);
        if (verdict.facing_away()) {
            ++score.facing_away;
            score.facing_away_errors += wrong && !verdict.ambiguous();
            continue;
        }
        score.ambiguous += verdict.ambiguous();
        score.disagreeing[0] += wrong && (verdict.bits & Verdict::kWithin1);
        score.disagreeing[1] += wrong && (verdict.bits & Verdict::kWithin4);
        score.disagreeing[2] += wrong && (verdict.bits & Verdict::kWithin16);
        const Error error = error_of(verdict, visible.lit(i));
        score.false_lit += error == Error::false_lit;
        score.false_shadowed += error == Error::false_shadowed;
    }
    const std::vector<std::uint32_t> leaks =
        leak_sizes(error_mask(verdicts, visible, width, height), width, height);
    score.leaks = static_cast<std::uint32_t>(leaks.size());
    for (const std::uint32_t size : leaks) score.leak_largest = std::max(score.leak_largest, size);
    return score;
}

}  // namespace shadows::truth
