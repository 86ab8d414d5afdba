#include "experiments/image/color_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace experiments::image {
namespace {

/// Lightness, chroma and hue (in turns) of OKLab to linear sRGB, cut to the gamut.
glm::vec3 from_oklch(float lightness, float chroma, float hue) {
    const float angle = 2 * std::numbers::pi_v<float> * hue;
    const float a = chroma * std::cos(angle), b = chroma * std::sin(angle);
    const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    const glm::vec3 lms(l * l * l, m * m * m, s * s * s);
    const glm::vec3 rgb(glm::dot(glm::vec3(4.0767416621f, -3.3077115913f, 0.2309699292f), lms),
                        glm::dot(glm::vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f), lms),
                        glm::dot(glm::vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f), lms));
    return glm::clamp(rgb, 0.0f, 1.0f);
}

}  // namespace

glm::vec3 heat_color(float t) {
    t = std::clamp(t, 0.0f, 1.0f);
    // Lightness is linear in t; the hue runs from violet through red to yellow; the chroma bulges
    // in the middle, where the gamut has room for it.
    const float lightness = 0.16f + 0.80f * t;
    const float hue = 0.80f + 0.50f * t;  // 1 is 0 again: red
    const float chroma = 0.05f + 0.62f * t * (1 - t);
    return from_oklch(lightness, chroma, hue);
}

glm::vec3 signed_color(float t) {
    t = std::clamp(t, -1.0f, 1.0f);
    const float size = std::abs(t);
    return from_oklch(0.96f - 0.50f * size, 0.19f * std::sqrt(size), t < 0 ? 0.71f : 0.07f);
}

Image heat_image(std::span<const float> values, int width, int height, float low, float high) {
    if (width <= 0 || height <= 0 || values.size() != std::size_t(width) * std::size_t(height))
        throw std::invalid_argument(
            fmt::format("heat_image: {} values for {} x {} pixels", values.size(), width, height));
    if (!(low < high))
        throw std::invalid_argument(fmt::format("heat_image: {} is not below {}", low, high));
    Image image(width, height, 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::vec3 color = std::isfinite(values[i])
                                    ? heat_color((values[i] - low) / (high - low))
                                    : glm::vec3(0, 1, 0);
        for (int c = 0; c < 3; ++c) image.values[3 * i + c] = color[c];
    }
    return image;
}

}  // namespace experiments::image
