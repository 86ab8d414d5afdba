// Starting Vulkan and describing its devices; shared by list_devices() and Device.
#pragma once

#include <vulkan/vulkan_core.h>

#include <utility>
#include <vector>

#include "taskpool/gpu/device_list.hpp"

namespace taskpool::gpu {

inline constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
bool validation_installed();

/// `validation` also turns on synchronisation validation.
VkInstance create_instance(bool validation);

struct PhysicalDevice {
    VkPhysicalDevice handle;
    DeviceInfo info;
};
/// Best first, as list_devices() promises.
std::vector<PhysicalDevice> enumerate(VkInstance instance);

}  // namespace taskpool::gpu
