// Brings the corners of triangles, in an order that a structure wants, into one array.
#pragma once

#include "structures/geometry/corner_triangle.h"
#include "taskpool/gpu/recorder.hpp"

namespace structures::geometry {

class GatherTriangles {
  public:
    explicit GatherTriangles(taskpool::gpu::Device& device);

    /// Device addresses: uint[count] of triangles, vec3[] of positions, uvec3[triangle_count] of
    /// corners, and CornerTriangle[count] of what is written. Places of `order` that name no
    /// triangle get the primitive 0xffffffff and corners of 0.
    struct Arrays {
        std::uint64_t order, positions, corners, target;
        std::uint32_t count, triangle_count;
    };
    /// No barriers.
    void record(taskpool::gpu::Recorder& recorder, const Arrays& arrays) const;

  private:
    taskpool::gpu::Kernel kernel_;
};

}  // namespace structures::geometry
