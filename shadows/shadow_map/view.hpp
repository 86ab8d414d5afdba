// The views of a shadow map: how the light sees the scene, from the bounds that fit.comp found.
//
//     Frame frame = make_frame(light, casters.bounds());
//     std::array<View, kFaces> views = make_views(fit, config, directional);
#pragma once

#include <array>
#include <cstdint>

#include "shadows/shadow_map/view_shared.h"
#include "structures/geometry/aabb.hpp"
#include "structures/geometry/light.hpp"

namespace shadows::shadow_map {

/// What keeps a surface from shadowing itself, its depth being stored at texels' centres only.
enum class BiasMode {
    constant,       ///< stored depths move back alike: by `bias` widths of a texel
    slope,          ///< each triangle by what its depth changes over `bias` texels (rasteriser)
    receiver_plane  ///< depth is compared at the texel's centre, on the receiver's plane (Isidoro
                    ///< 2006); stored depths move back by `bias` widths of a texel
};

/// A bias that serves most scenes: measured on interiors and generated scenes, at 2048 texels.
constexpr float usual_bias(BiasMode mode) {
    return mode == BiasMode::constant ? 3 : mode == BiasMode::slope ? 1 : 0.25f;
}

struct MapConfig {
    std::uint32_t resolution = 2048;  ///< texels along a side of a map
    BiasMode bias_mode = BiasMode::receiver_plane;
    float bias = usual_bias(BiasMode::receiver_plane);
    bool operator==(const MapConfig&) const = default;
};

/// Throws std::invalid_argument unless the light is finite and, if directional, has a direction.
Frame make_frame(const structures::geometry::Light& light,
                 const structures::geometry::Aabb& casters);

/// Each face's view, fitted to the casters that reach into it: a rectangle of the face, and a near
/// plane in front of the nearest. A texel is as wide as the rectangle over the resolution, so a
/// light that sees the scene as small gets fine texels. Faces without casters have no map.
std::array<View, kFaces> make_views(const Fit& fit, const MapConfig& config, bool directional);

/// How far from its axis a face of a point light's cube is drawn: 1, and beyond it the texels whose
/// centres a lookup at 1 may take.
inline float face_reach(const MapConfig& config) { return 1 + 4 / float(config.resolution); }

}  // namespace shadows::shadow_map
