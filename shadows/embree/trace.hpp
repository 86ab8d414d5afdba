// Shadow rays of a range of points through Embree, one at a time, in packets or in
// streams.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <span>

#include "shadows/points.hpp"
#include "structures/geometry/light.hpp"

namespace shadows::embree {

/// The ray of point p is origin + t * direction, t in (near, far).
///
/// Point light: from the light towards p, all rays from one origin, so packets are coherent at the
/// root; direction = p - light, and far = 1 - bias keeps the receiver itself out.
/// Directional light: from p towards the light; parallel rays are coherent whatever their origin,
/// and starting at p keeps the intersection's rounding relative to nearby vertices, which an origin
/// outside the scene would not. The direction has the length of the scene's diagonal, so that
/// near = bias means the same fraction as above.
struct ShadowRays {
    ShadowRays(const structures::geometry::Light& light, float scene_diagonal, float bias);

    bool from_light;
    glm::vec3 vector;  ///< origin (point light) or direction (directional light)
    float near, far;
};

/// Points first .. first + count (multiples of 64) of `points`: sets their bits in `words`, the
/// whole visibility mask, 1 = lit. Points without geometry are not traced and get 1.
using Trace = void (*)(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                       std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words);

void trace_single(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                  std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words);
/// Packets of 8 or 16 consecutive points.
void trace_packets_8(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                     std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words);
void trace_packets_16(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                      std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words);
/// Coherent streams of 64 consecutive points, which Embree cuts up as it sees fit.
void trace_streams(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                   std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words);

}  // namespace shadows::embree
