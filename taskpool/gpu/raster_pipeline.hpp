// A rasterisation pipeline: triangles whose vertices a shader fetches itself, by buffer address,
// from its gl_VertexIndex. No vertex input and no descriptors; dynamic rendering.
//
//     RasterOptions options;
//     options.color_formats = {VK_FORMAT_R32_UINT};
//     options.depth_format = VK_FORMAT_D32_SFLOAT;
//     RasterPipeline pipeline(device, vertex_shader, fragment_shader, options);
//     recorder.begin_rendering("ids", {{{&ids, {.uint32 = {~0u}}}}, &depth, 0});
//     recorder.draw(pipeline, push, 3 * triangle_count);
//     recorder.end_rendering();
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taskpool/gpu/kernel.hpp"

namespace taskpool::gpu {

struct RasterOptions {
    std::vector<VkFormat> color_formats;                ///< one per colour target
    VkFormat depth_format = VK_FORMAT_UNDEFINED;        ///< undefined: no depth target
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;  ///< reversed depth: nearer is larger
    bool depth_write = true;
    bool depth_clamp = false;                             ///< clamp to the depth range, not clip
    float depth_bias_constant = 0, depth_bias_slope = 0;  ///< as Vulkan's depth bias factors
    VkCullModeFlags cull = VK_CULL_MODE_NONE;             ///< front faces: counter-clockwise
    std::vector<Constant> constants;                      ///< for both shaders
};

/// Move-only.
class RasterPipeline {
  public:
    RasterPipeline() = default;
    RasterPipeline(Device& device, const Shader& vertex, const Shader& fragment,
                   const RasterOptions& options);
    ~RasterPipeline();
    RasterPipeline(RasterPipeline&& other) noexcept { swap(other); }
    RasterPipeline& operator=(RasterPipeline&& other) noexcept {
        swap(other);
        return *this;
    }

    VkPipeline handle() const { return pipeline_; }

  private:
    void swap(RasterPipeline& other) noexcept;

    Device* device_ = nullptr;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace taskpool::gpu
