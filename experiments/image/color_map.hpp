// Colours for numbers.
//
//     Image picture = heat_image(values, width, height, 0, 200);   // 0 dark violet, 200 pale
//     yellow
//
// The maps are paths through OKLab (B. Ottosson, "A perceptual color space for image processing",
// 2020), so that equal steps of the value look about equally large and lightness alone orders them:
// they read the same in grey and to colour-blind eyes.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "experiments/image/image.hpp"

namespace experiments::image {

/// Linear RGB for `t` in [0, 1] (clamped): near black, violet, red, orange, pale yellow.
glm::vec3 heat_color(float t);

/// Linear RGB for `t` in [-1, 1] (clamped): blue below 0, near white at 0, red above.
glm::vec3 signed_color(float t);

/// A picture of width * height values, `low` and below at the dark end of the heat map, `high` and
/// above at the bright end; values that are not finite are green, which the map does not hold.
/// Throws std::invalid_argument unless there is a value per pixel and low < high.
Image heat_image(std::span<const float> values, int width, int height, float low, float high);

}  // namespace experiments::image
