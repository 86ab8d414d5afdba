#include "structures/geometry/gather_triangles.hpp"

#include <algorithm>

std::span<const taskpool::gpu::Shader> structures_geometry_shaders();

namespace structures::geometry {

GatherTriangles::GatherTriangles(taskpool::gpu::Device& device)
    : kernel_(device, taskpool::gpu::find_shader(structures_geometry_shaders(),
                                                 "structures/geometry/gather_triangles.comp")) {}

void GatherTriangles::record(taskpool::gpu::Recorder& recorder, const Arrays& arrays) const {
    if (arrays.count == 0) return;
    recorder.dispatch(kernel_, arrays, std::min(arrays.count / 1024 + 1, 8192u));
}

}  // namespace structures::geometry
