// A command buffer being written. Algorithms record; whoever owns the device submits:
//
//     Recorder recorder(device);
//     recorder.timestamp(times, "begin");
//     recorder.dispatch(kernel, push, groups);
//     recorder.barrier();                      // later commands see what earlier ones wrote
//     recorder.timestamp(times, "end");
//     device.run(recorder);
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "taskpool/gpu/buffer.hpp"
#include "taskpool/gpu/image.hpp"
#include "taskpool/gpu/kernel.hpp"
#include "taskpool/gpu/raster_pipeline.hpp"
#include "taskpool/gpu/timestamps.hpp"

namespace taskpool::gpu {

/// What a rendering draws into, all of one size, and what it is cleared to first.
struct RenderTargets {
    struct Color {
        const Image* image;
        VkClearColorValue clear;
    };
    std::vector<Color> colors;
    const Image* depth = nullptr;
    float clear_depth = 0;
};

class Recorder {
  public:
    explicit Recorder(Device& device);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Runs groups_x * groups_y workgroups (one subgroup each) of `kernel`.
    template <typename Push>
    void dispatch(const Kernel& kernel, const Push& push, std::uint32_t groups_x,
                  std::uint32_t groups_y = 1) {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kPushBytes);
        record_dispatch(kernel, &push, sizeof(Push), groups_x, groups_y);
    }
    /// Workgroup counts (three words) from `arguments` at byte `offset`.
    template <typename Push>
    void dispatch_indirect(const Kernel& kernel, const Push& push, const Buffer& arguments,
                           std::size_t offset = 0) {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kPushBytes);
        record_indirect(kernel, &push, sizeof(Push), arguments, offset);
    }
    /// Everything before is finished and visible to everything after, on the device and the host.
    void barrier();
    /// Sets every word of [offset, offset + bytes) to `word`; bytes 0 means to the end.
    void fill(const Buffer& buffer, std::uint32_t word, std::size_t offset = 0,
              std::size_t bytes = 0);
    void copy(const Buffer& source, const Buffer& target, std::size_t bytes,
              std::size_t source_offset = 0, std::size_t target_offset = 0);
    void timestamp(Timestamps& timestamps, std::string label);

    /// Clears the targets and starts drawing into them, over their whole area. `name` is what a
    /// lost device is reported with. Earlier contents of the images are gone.
    void begin_rendering(const std::string& name, const RenderTargets& targets);
    /// Draws vertex_count / 3 triangles; only between begin_rendering and end_rendering.
    template <typename Push>
    void draw(const RasterPipeline& pipeline, const Push& push, std::uint32_t vertex_count) {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kPushBytes);
        record_draw(pipeline, &push, sizeof(Push), vertex_count);
    }
    /// Ends the rendering and waits for it; the targets can be copied from then on.
    void end_rendering();
    /// Copies the image's texels (of `aspect`, one of the image's), row by row without gaps, to
    /// `target` from byte `offset` on. The image must have been a target in this recorder.
    void copy(const Image& source, VkImageAspectFlagBits aspect, const Buffer& target,
              std::size_t offset = 0);

    VkCommandBuffer handle() const { return commands_; }
    Device& device() const { return device_; }

  private:
    friend class Device;
    void record_dispatch(const Kernel& kernel, const void* push, std::uint32_t bytes,
                         std::uint32_t groups_x, std::uint32_t groups_y);
    void record_indirect(const Kernel& kernel, const void* push, std::uint32_t bytes,
                         const Buffer& arguments, std::size_t offset);
    void record_draw(const RasterPipeline& pipeline, const void* push, std::uint32_t bytes,
                     std::uint32_t vertex_count);
    void prepare(const Kernel& kernel, const void* push, std::uint32_t bytes);
    /// Leaves word that `name` starts now, for running_kernel().
    void leave_breadcrumb(const std::string& name);
    /// Moves the targets of the rendering under way from one layout to another; a full barrier.
    void move_targets(VkImageLayout from, VkImageLayout to);
    /// The kernel that had been started last when the device was lost.
    std::string running_kernel() const;

    Device& device_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    std::vector<std::string> kernels_;   ///< in order of recording
    std::vector<const Image*> targets_;  ///< of the rendering under way
    Buffer breadcrumbs_;                 ///< a host-visible word per kernel: 1 once started
};

}  // namespace taskpool::gpu
