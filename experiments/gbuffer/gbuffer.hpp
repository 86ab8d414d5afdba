// What a camera sees, as the points of a shadow query: rasterised on the GPU.
//
//     GBuffer seen = render_gbuffer(device, mesh, camera, 1920, 1080);
//     method->query(seen.points, visible);
//
// A visibility buffer (C. A. Burns and W. A. Hunt, "The Visibility Buffer", JCGT 2013): rasterise
// primitive ids with depth, then compute per pixel what else is wanted from the triangle itself. It
// decouples the precision of the points from that of the rasteriser.
#pragma once

#include <cstdint>

#include "experiments/scenes/camera.hpp"
#include "shadows/points.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/gpu/device.hpp"

namespace experiments::gbuffer {

struct GBuffer {
    shadows::Points points;
    double milliseconds;  ///< GPU time of rasterisation and resolve, after a warm-up
};

/// The points at the pixels' centres. Each lies on its triangle as exactly as single precision can
/// say (computed in double precision, rounded once); normals are of unit length and face the
/// camera. Triangles seen edge on or without area are not seen. Of coincident surfaces either may
/// win, the same one on every run. Throws std::invalid_argument if a side of the image is not in
/// 1..4096 or the camera is unusable (Camera::fault), gpu::Error if memory does not suffice.
GBuffer render_gbuffer(taskpool::gpu::Device& device,
                       const structures::geometry::TriangleMesh& mesh, const scenes::Camera& camera,
                       std::uint32_t width, std::uint32_t height);

}  // namespace experiments::gbuffer
