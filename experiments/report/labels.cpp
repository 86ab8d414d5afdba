#include "experiments/report/labels.hpp"

#include <algorithm>
#include <cmath>

namespace experiments::report {

bool LabelPlaces::find(double x, double y, double width, double height, double reach, Box& place) {
    // Nearest first; at each distance to the right, to the left, then all around.
    static constexpr double kDegrees[] = {0, 180, -30, 30, 210, 150, -60, 60, 240, 120, -90, 90};
    for (double distance = 9; distance <= std::max(reach, 9.0); distance += 6)
        for (const double degrees : kDegrees) {
            const double angle = degrees * std::acos(-1) / 180;
            const double dx = std::cos(angle), dy = std::sin(angle);
            // The point of the label's box nearest to the mark lies `distance` away from it.
            const double middle = x + distance * dx + 0.5 * width * std::clamp(2 * dx, -1.0, 1.0);
            const double centre = y + distance * dy + 0.5 * height * std::clamp(2 * dy, -1.0, 1.0);
            const Box box{middle - 0.5 * width, centre - 0.5 * height, middle + 0.5 * width,
                          centre + 0.5 * height};
            if (!area_.holds(box) || std::any_of(taken_.begin(), taken_.end(),
                                                 [&](const Box& b) { return b.overlaps(box); }))
                continue;
            taken_.push_back(box);
            place = box;
            return true;
        }
    return false;
}

}  // namespace experiments::report
