// A method's answer against the truth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shadows/truth/truth.hpp"

namespace shadows::truth {

/// Counts of points. Errors are those of certain points that face the light.
struct Score {
    std::uint32_t points = 0;          ///< with geometry
    std::uint32_t facing_away = 0;     ///< of these, whose receiver faces away; in no error count
    std::uint32_t ambiguous = 0;       ///< facing the light, within the band
    std::uint32_t false_lit = 0;       ///< certainly shadowed, called lit
    std::uint32_t false_shadowed = 0;  ///< certainly lit, called shadowed
    /// Ambiguous points, within 1, 4 and 16 epsilon, whose answer differs from the exact one.
    std::array<std::uint32_t, 3> disagreeing{};
    std::uint32_t facing_away_errors = 0;  ///< facing away, certain, answered wrongly
    std::uint32_t leaks = 0;         ///< clusters of false-lit pixels, joined by sides or corners
    std::uint32_t leak_largest = 0;  ///< pixels of the largest
};

/// Compares `visible` with `verdicts`, both in the order of the points of a `width` x `height`
/// image. Throws std::invalid_argument if their lengths do not fit it.
Score score_answer(const Verdicts& verdicts, const Visibility& visible, std::uint32_t width,
                   std::uint32_t height);

enum class Error : std::uint8_t { none, false_lit, false_shadowed, in_band };
/// What is wrong with the answer at each pixel, row by row from the top; in_band: it differs from
/// the exact one, but the point is ambiguous.
std::vector<Error> error_mask(const Verdicts& verdicts, const Visibility& visible,
                              std::uint32_t width, std::uint32_t height);

}  // namespace shadows::truth
