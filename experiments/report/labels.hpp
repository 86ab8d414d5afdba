// Finds room for the labels of a plot's marks.
#pragma once

#include <string>
#include <vector>

namespace experiments::report {

struct Box {
    double left, top, right, bottom;
    bool overlaps(const Box& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
    bool holds(const Box& other) const {
        return left <= other.left && top <= other.top && other.right <= right &&
               other.bottom <= bottom;
    }
};

class LabelPlaces {
  public:
    /// Labels stay within `area` and off the boxes in `taken`.
    LabelPlaces(const Box& area, std::vector<Box> taken) : area_(area), taken_(std::move(taken)) {}

    /// Room for a label of `width` x `height` near the mark at (x, y), up to `reach` away from it;
    /// it is taken from then on. Returns false if there is none.
    bool find(double x, double y, double width, double height, double reach, Box& place);

  private:
    Box area_;
    std::vector<Box> taken_;
};

}  // namespace experiments::report
