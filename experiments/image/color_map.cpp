// Colour maps as paths through OKLab.
#include "experiments/image/color_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace experiments::image {
namespace {

/// OKLab to linear sRGB, which may be out of gamut.
glm::vec3 from_oklab(float lightness, glm::vec2 ab) {
    const float l = lightness + 0.3963377774f * ab.x + 0.2158037573f * ab.y;
    const float m = lightness - 0.1055613458f * ab.x - 0.0638541728f * ab.y;
    const float s = lightness - 0.0894841775f * ab.x - 1.2914855480f * ab.y;
    const glm::vec3 lms(l * l * l, m * m * m, s * s * s);
    return {glm::dot(glm::vec3(4.0767416621f, -3.3077115913f, 0.2309699292f), lms),
            glm::dot(glm::vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f), lms),
            glm::dot(glm::vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f), lms)};
}

/// Lightness, chroma and hue (in turns) to linear sRGB. A colour outside the gamut gives up chroma,
/// not lightness.
glm::vec3 from_oklch(float lightness, float chroma, float hue) {
    const float angle = 2 * std::numbers::pi_v<float> * hue;
    const glm::vec2 direction(std::cos(angle), std::sin(angle));
    float inside = 0, outside = chroma;
    for (int step = 0; step < 12; ++step) {
        const float middle = 0.5f * (inside + outside);
        const glm::vec3 rgb = from_oklab(lightness, middle * direction);
        const bool fits = rgb == glm::clamp(rgb, 0.0f, 1.0f);
        (fits ? inside : outside) = middle;
    }
    return glm::clamp(from_oklab(lightness, inside * direction), 0.0f, 1.0f);
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
    constexpr int kShades = 1024;
    std::vector<glm::vec3> shades(kShades);
    for (int i = 0; i < kShades; ++i) shades[i] = heat_color(float(i) / (kShades - 1));
    Image image(width, height, 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float t = std::clamp((values[i] - low) / (high - low), 0.0f, 1.0f);
        const glm::vec3 color =
            std::isfinite(values[i])
                ? shades[static_cast<std::size_t>(std::lround(t * (kShades - 1)))]
                : glm::vec3(0, 1, 0);
        for (int c = 0; c < 3; ++c) image.values[3 * i + c] = color[c];
    }
    return image;
}

}  // namespace experiments::image
