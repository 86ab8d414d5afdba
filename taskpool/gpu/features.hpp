// The device features Grove needs: one list, used both to ask a device and to enable them.
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>
#include <vector>

namespace taskpool::gpu {

/// A chain of feature structures. Not copyable: the structures point at each other.
struct FeatureChain {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceShaderClockFeaturesKHR clock{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR};

    /// `has_shader_clock`: whether the device has the extension; without, its feature stays off.
    explicit FeatureChain(bool has_shader_clock = true);
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;

    /// Turns on every required feature.
    void require_all();
    /// Names of required features that are off.
    std::vector<std::string> missing() const;
};

}  // namespace taskpool::gpu
