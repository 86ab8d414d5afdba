#include "shadows/shadow_map/view.hpp"

#include <algorithm>
#include <cmath>

#include "taskpool/primitives/ordered.hpp"

namespace shadows::shadow_map {
namespace {

using structures::geometry::Light;

/// What rounding may do to depths of a directional light, which span 0 to 1.
constexpr float kRounding = 1.f / (1 << 19);

/// Scale and offset that take [lower, upper] and a texel on either side to [-1, 1].
void fit_axis(float lower, float upper, const MapConfig& config, float& scale, float& offset) {
    // Casters seen edge on have no width: not less than single precision resolves.
    constexpr float kNarrowest = 1.f / (1 << 20);
    const float middle = 0.5f * lower + 0.5f * upper;
    const float reach = std::max(std::abs(lower), std::abs(upper));
    const float half = std::max({0.5f * upper - 0.5f * lower, reach * kNarrowest, 1e-30f}) *
                       (1 + 2 / float(config.resolution));
    scale = 1 / half;
    offset = -middle / half;
}

View make_view(const std::uint32_t* bounds, const MapConfig& config, bool directional) {
    const auto bound = [&](std::uint32_t which) {
        return taskpool::primitives::from_ordered(bounds[which]);
    };
    const float near = bound(kNear), far = -bound(kMinusFar);
    View view{};
    fit_axis(bound(kLeft), -bound(kMinusRight), config, view.scale.x, view.offset.x);
    fit_axis(bound(kTop), -bound(kMinusBottom), config, view.scale.y, view.offset.y);
    // Width of a texel at distance 1 from the light; of a directional light, anywhere.
    const float texel = 2 / (std::min(view.scale.x, view.scale.y) * float(config.resolution));
    const float bias = config.bias_mode == BiasMode::slope ? 0 : config.bias * texel;
    if (directional) {
        // As deep as it is wide at least: w is rounded as the other coordinates are. A little room
        // before and behind, so that no rounding clips a caster and none is moved back below 0.
        const float width = 1 / std::min(view.scale.x, view.scale.y);
        const float depth = 1.0625f * std::max(far - near, width) + 2 * bias;
        view.per_depth = 1 / depth;
        view.near = 0.5f + view.per_depth * (0.5f * near + 0.5f * far);
        view.bias = bias * view.per_depth + kRounding;
    } else {
        // A light that touches a triangle leaves out what is nearer than this part of the scene.
        view.near = std::max({near, far / (1 << 16), 1e-30f});
        view.bias = bias;
    }
    return view;
}

}  // namespace

Frame make_frame(const Light& light, const structures::geometry::Aabb& casters) {
    structures::geometry::require_usable(light);
    const bool directional = light.type == Light::Type::directional;
    const glm::vec3 v = light.vector;
    const float longest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    Frame frame{};
    frame.origin = directional ? casters.empty() ? glm::vec3(0) : casters.center() : v;
    if (!directional) return frame;
    const glm::dvec3 forward = glm::normalize(glm::dvec3(v) / double(longest));
    const glm::dvec3 size = glm::abs(forward);
    glm::dvec3 across(0);
    across[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
    const glm::dvec3 right = glm::normalize(glm::cross(across, forward));
    frame.right = right;
    frame.down = glm::cross(forward, right);
    frame.forward = forward;
    return frame;
}

std::array<View, kFaces> make_views(const Fit& fit, const MapConfig& config, bool directional) {
    std::array<View, kFaces> views;
    std::uint32_t slots = 0;
    for (std::uint32_t face = 0; face < kFaces; ++face) {
        if (fit.casters[face] > 0) {
            views[face] = make_view(fit.bounds + face * kBounds, config, directional);
            views[face].slot = slots++;
        } else {
            views[face] = View{};
            views[face].offset = {2, 2};
        }
    }
    return views;
}

}  // namespace shadows::shadow_map
