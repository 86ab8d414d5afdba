// A Vulkan device with one compute queue: the root of everything on the GPU.
//
//     gpu::Device device(gpu::DeviceOptions{});
//     gpu::Buffer data = gpu::make_buffer<float>(device, values, "values");
//     gpu::Kernel kernel(device, gpu::find_shader(my_shaders(), "my/kernel.comp"));
//     gpu::Recorder recorder(device);
//     recorder.dispatch(kernel, Push{data.address(), 1000}, 16);
//     device.run(recorder);                       // submits and waits
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "taskpool/gpu/device_list.hpp"
#include "taskpool/gpu/error.hpp"

namespace taskpool::gpu {

class Recorder;

struct DeviceOptions {
    int index = -1;           ///< into list_devices(); -1: the first usable one
    bool validation = false;  ///< Khronos validation with synchronisation checks, if installed
    /// Receives each validation message of warning severity or worse.
    std::function<void(const std::string&)> on_validation_message{};
    /// Supplies SPIR-V for a shader path instead of the embedded code, or nothing to keep it.
    std::function<std::optional<std::vector<std::uint32_t>>(std::string_view path)> shader_source{};
};

/// Push constants are at most this many bytes: what Vulkan guarantees.
inline constexpr std::uint32_t kPushBytes = 128;

class Device {
  public:
    /// Throws Error if there is no such device, or it lacks a required feature (named).
    explicit Device(DeviceOptions options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    std::uint32_t subgroup_size() const { return info_.subgroup_size; }
    const DeviceOptions& options() const { return options_; }
    /// False if validation was asked for but the layer is not installed.
    bool validating() const { return messenger_ != VK_NULL_HANDLE; }

    /// Submits what `recorder` holds and waits for it. Throws Error; a lost device is reported with
    /// the name of the kernel that was running. The recorder is spent afterwards.
    void run(Recorder& recorder);

    /// Bytes in buffers and images now, and at most since the last reset_peak().
    std::uint64_t allocated_bytes() const { return allocated_; }
    std::uint64_t peak_bytes() const { return peak_; }
    void reset_peak() { peak_ = allocated_.load(); }

    /// Whether pipelines must ask for the subgroup size (a device that offers several).
    bool requires_subgroup_size() const {
        return info_.min_subgroup_size != info_.max_subgroup_size;
    }

    // For the classes of this folder, and for rasterisation.
    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkPipelineLayout layout() const { return layout_; }
    VkCommandPool command_pool() const { return command_pool_; }
    std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const;
    VkMemoryPropertyFlags memory_flags(std::uint32_t type) const;
    void name_object(VkObjectType type, std::uint64_t object, const std::string& name) const;
    void count_allocation(std::int64_t bytes);

  private:
    void create_instance();
    void create_device();

    DeviceOptions options_;
    DeviceInfo info_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool command_pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    std::atomic<std::uint64_t> allocated_{0}, peak_{0};
};

/// What Error says when `device` was lost while `kernel` (empty: none) was running.
std::string device_lost_message(const std::string& device, const std::string& kernel);

}  // namespace taskpool::gpu
