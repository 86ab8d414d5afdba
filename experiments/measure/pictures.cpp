#include "experiments/measure/pictures.hpp"

#include <algorithm>
#include <cctype>
#include <glm/glm.hpp>

#include "experiments/image/color_map.hpp"
#include "experiments/measure/digest.hpp"

namespace experiments::measure {
namespace {

using image::Image;
using shadows::truth::Error;

/// `value(point)` of every pixel, in rows.
template <typename Function>
Image per_pixel(const shadows::Points& points, int channels, const Function& value) {
    Image picture(int(points.width()), int(points.height()), channels);
    for (std::uint32_t y = 0; y < points.height(); ++y)
        for (std::uint32_t x = 0; x < points.width(); ++x)
            for (int c = 0; c < channels; ++c)
                picture.at(int(x), int(y), c) =
                    value(shadows::point_index(x, y, points.width()))[c];
    return picture;
}

/// Diffuse grey surfaces under the light, darkened where shadowed.
Image shade(const shadows::Points& points, const shadows::Visibility& visible,
            const structures::geometry::Light& light) {
    const glm::vec3 background(0.55f, 0.65f, 0.78f), surface(0.72f, 0.69f, 0.64f);
    const bool is_point = light.type == structures::geometry::Light::Type::point;
    const auto& host = points.host();
    return per_pixel(points, 3, [&](std::uint32_t i) {
        if (host.primitive[i] == shadows::kNoPrimitive) return background;
        const glm::vec3 position(host.x[i], host.y[i], host.z[i]);
        const glm::vec3 to_light =
            glm::normalize(is_point ? light.vector - position : -light.vector);
        const glm::vec3 normal = host.normal[i];
        // A little light from everywhere, more from above, keeps shapes readable in the shadow.
        const float ambient = 0.10f + 0.05f * normal.y;
        const float direct = visible.lit(i) ? std::max(0.f, glm::dot(normal, to_light)) : 0.f;
        return surface * (ambient + 0.9f * direct);
    });
}

/// A round dot around the pixel, cut off at the borders.
void draw_dot(Image& picture, int x, int y, int radius, const glm::vec3& color) {
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const bool inside = x + dx >= 0 && x + dx < picture.width && y + dy >= 0 &&
                                y + dy < picture.height &&
                                dx * dx + dy * dy <= radius * (radius + 1);
            for (int c = 0; inside && c < 3; ++c) picture.at(x + dx, y + dy, c) = color[c];
        }
}

}  // namespace

Pictures::Pictures(RunFolder& folder, std::string scene, std::string method, std::string variant)
    : folder_(folder),
      scene_(std::move(scene)),
      method_(std::move(method)),
      variant_(std::move(variant)),
      stem_(file_name(scene_ + "-" + method_ + "-" + variant_)) {}

void Pictures::shaded(const shadows::Points& points, const shadows::Visibility& visible,
                      const structures::geometry::Light& light) {
    const std::string file = stem_ + "-shaded.png";
    try {
        image::write_png(folder_.images() / file, shade(points, visible, light));
    } catch (const image::FileError& error) {
        throw OutputError(error.what());
    }
    enter("shaded", file);
}

void Pictures::visibility(const shadows::Points& points, const shadows::Visibility& visible) {
    const Image mask = per_pixel(
        points, 1, [&](std::uint32_t i) { return glm::vec1(visible.lit(i) ? 1.f : 0.f); });
    save("visibility", mask, {{"visibility"}}, mask);
}

void Pictures::difference(const shadows::Points& points, const shadows::Visibility& visible,
                          std::span<const std::uint32_t> reference) {
    bool any = false;
    const Image sign = per_pixel(points, 1, [&](std::uint32_t i) {
        if (points.host().primitive[i] == shadows::kNoPrimitive) return glm::vec1(0);
        const float mine = visible.lit(i), other = float(reference[i / 32] >> (i % 32) & 1u);
        any = any || mine != other;
        return glm::vec1(mine - other);
    });
    if (!any) return;
    Image preview(sign.width, sign.height, 3, 0.9f);
    for (int y = 0; y < sign.height; ++y)
        for (int x = 0; x < sign.width; ++x)
            if (const float value = sign.at(x, y, 0); value != 0)
                for (int c = 0; c < 3; ++c) preview.at(x, y, c) = image::signed_color(value)[c];
    save("difference", sign, {{"difference"}}, preview);
}

void Pictures::errors(const shadows::Points& points, const shadows::Visibility& visible,
                      const structures::geometry::Light& light, std::span<const Error> mask) {
    static const std::string kChannels[] = {"false_lit", "false_shadowed", "in_band"};
    // In the order of drawing: what counts as an error comes last, on top.
    static const std::pair<Error, glm::vec3> kColors[] = {
        {Error::in_band, {0.9f, 0.65f, 0.0f}},
        {Error::false_shadowed, {0.01f, 0.1f, 0.9f}},
        {Error::false_lit, {0.85f, 0.01f, 0.01f}}};
    Image exact(int(points.width()), int(points.height()), 3);
    std::size_t count = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == Error::none) continue;
        exact.values[3 * i + (std::size_t(mask[i]) - std::size_t(Error::false_lit))] = 1;
        ++count;
    }
    if (count == 0) return;
    // Single pixels are lost on a screen; where there are many they show by themselves.
    const int radius = count > mask.size() / 200 ? 0 : std::max(2, exact.width / 480);
    Image preview = shade(points, visible, light);
    for (const auto& [kind, color] : kColors)
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask[i] == kind)
                draw_dot(preview, int(i % points.width()), int(i / points.width()), radius, color);
    save("errors", exact, kChannels, preview);
}

void Pictures::heat(const shadows::Points& points, const std::vector<float>& cost) {
    if (cost.size() != points.count()) return;
    const Image picture = per_pixel(points, 1, [&](std::uint32_t i) { return glm::vec1(cost[i]); });
    std::vector<float> sorted = picture.values;
    const auto rank = sorted.begin() + std::ptrdiff_t(0.99 * double(sorted.size() - 1));
    std::nth_element(sorted.begin(), rank, sorted.end());
    save("heat", picture, {{"cost"}},
         image::heat_image(picture.values, picture.width, picture.height, 0, std::max(1.f, *rank)));
}

void Pictures::save(const std::string& kind, const Image& exact,
                    std::span<const std::string> channels, const Image& preview) {
    const std::string name = stem_ + "-" + kind;
    try {
        image::write_exr(folder_.images() / (name + ".exr"), exact, channels);
        image::write_png(folder_.images() / (name + ".png"), preview);
    } catch (const image::FileError& error) {
        throw OutputError(error.what());
    }
    enter(kind, name + ".png");
}

void Pictures::enter(const std::string& kind, const std::string& file) {
    nlohmann::json& list = folder_.manifest["images"];
    if (!list.is_array()) list = nlohmann::json::array();
    const nlohmann::json entry = {{"scene", scene_},
                                  {"method", method_},
                                  {"variant", variant_},
                                  {"kind", kind},
                                  {"file", "images/" + file}};
    if (std::find(list.begin(), list.end(), entry) == list.end()) list.push_back(entry);
}

}  // namespace experiments::measure
