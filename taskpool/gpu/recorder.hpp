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
#include "taskpool/gpu/kernel.hpp"
#include "taskpool/gpu/timestamps.hpp"

namespace taskpool::gpu {

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

    VkCommandBuffer handle() const { return commands_; }
    Device& device() const { return device_; }

  private:
    friend class Device;
    void record_dispatch(const Kernel& kernel, const void* push, std::uint32_t bytes,
                         std::uint32_t groups_x, std::uint32_t groups_y);
    void record_indirect(const Kernel& kernel, const void* push, std::uint32_t bytes,
                         const Buffer& arguments, std::size_t offset);
    void prepare(const Kernel& kernel, const void* push, std::uint32_t bytes);
    /// The kernel that had been started last when the device was lost.
    std::string running_kernel() const;

    Device& device_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    std::vector<std::string> kernels_;  ///< in order of recording
    Buffer breadcrumbs_;                ///< host-visible word: how many of `kernels_` were started
};

}  // namespace taskpool::gpu
