// A shadow map of hard shadows: the scene's depth as the light sees it, rasterised, and asked once
// per point. Williams 1978, "Casting curved shadows on curved surfaces".
//
//     ShadowMap map(device, {.resolution = 4096});
//     map.load(mesh);
//     double build_ms = map.render(light);
//     double query_ms = map.look_up(points, visible);
//
// A point light has a cube of maps, less the faces that no triangle reaches; a directional light
// has one. What a map covers is fitted to the triangles in it, and each face draws those it sees
// only. Depths are 32-bit floats, reversed: 1 near, 0 where nothing was drawn.
//
// It errs: within about a texel of every silhouette, where surfaces meet at less than the bias, and
// where a caster is thinner than a texel. Three choices of what to do about a surface's own depth
// are in view.hpp.
#pragma once

#include <array>

#include "shadows/points.hpp"
#include "shadows/shadow_map/view.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/gpu/recorder.hpp"

namespace shadows::shadow_map {

class ShadowMap {
  public:
    ShadowMap(taskpool::gpu::Device& device, const MapConfig& config);

    /// Uploads the mesh. Degenerate triangles and those with a corner that is not finite cast no
    /// shadow.
    void load(const structures::geometry::TriangleMesh& mesh);
    /// Draws the maps and returns the milliseconds that took on the device. Throws
    /// std::invalid_argument for an unusable light (make_frame), gpu::Error if the device has no
    /// images of this resolution or not the memory.
    double render(const structures::geometry::Light& light);
    /// Answers every point (Method::query) and returns the milliseconds that took on the device.
    double look_up(const Points& points, Visibility& visible);

    /// Maps drawn for the last light: 0 to 6, or 0 to 1 of a directional one.
    std::uint32_t faces() const;
    /// Mesh, lists of casters, bounds, views, maps and the image they are drawn in; not the answer.
    std::size_t memory_bytes() const;

  private:
    struct Programs {
        taskpool::gpu::Kernel fit, lookup;
        taskpool::gpu::RasterPipeline depth;
    };
    const Programs& programs();
    double find_bounds();
    void allocate_maps();
    double draw_maps();
    std::size_t map_bytes() const {
        return std::size_t{config_.resolution} * config_.resolution * 4;
    }

    taskpool::gpu::Device& device_;
    MapConfig config_;
    std::array<Programs, 2> programs_;  ///< point, directional; compiled when first needed
    taskpool::gpu::Timestamps times_;

    taskpool::gpu::Buffer positions_, triangles_;  ///< triangles_ of casters only
    taskpool::gpu::Buffer normals_;                ///< of every triangle, with receiver planes
    structures::geometry::Aabb bounds_;
    std::uint32_t triangle_count_ = 0;  ///< casters

    bool directional_ = false;
    Frame frame_{};
    Fit fit_{};
    std::array<View, kFaces> views_{};
    taskpool::gpu::Buffer fit_buffer_, casters_, view_buffer_, maps_, visible_;
    taskpool::gpu::Image target_;
};

}  // namespace shadows::shadow_map
