#include "taskpool/gpu/device_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>

#include "taskpool/gpu/error.hpp"
#include "taskpool/gpu/features.hpp"
#include "taskpool/gpu/instance.hpp"

namespace taskpool::gpu {
namespace {

bool has_extension(VkPhysicalDevice device, const char* name) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, name) == 0;
    });
}

DeviceType device_type(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return DeviceType::discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return DeviceType::integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return DeviceType::virtual_gpu;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return DeviceType::cpu;
        default:
            return DeviceType::other;
    }
}

/// Lavapipe before Mesa 23 cuts loops; its driverInfo reads "Mesa 22.3.6 (LLVM 15.0.6)".
std::uint32_t loop_limit(const VkPhysicalDeviceVulkan12Properties& properties) {
    int major = 0;
    if (properties.driverID != VK_DRIVER_ID_MESA_LLVMPIPE) return 0;
    if (std::sscanf(properties.driverInfo, "Mesa %d", &major) == 1 && major >= 23) return 0;
    return 65535;
}

/// One workgroup per worker thread on a CPU device. A GPU does not tell how many subgroups it holds
/// portably: enough to fill a large one without leaving a small one with a long tail.
std::uint32_t persistent_workgroups(DeviceType type) {
    if (type == DeviceType::cpu) return std::max(1u, std::thread::hardware_concurrency());
    return type == DeviceType::discrete ? 1024 : 128;
}

DeviceInfo describe(VkPhysicalDevice device) {
    VkPhysicalDeviceMaintenance3Properties limits{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceSubgroupSizeControlProperties sizes{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES, &limits};
    VkPhysicalDeviceSubgroupProperties subgroup{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, &sizes};
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES,
                                           &subgroup};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v12};
    // A Vulkan 1.0 device knows none of the chained structures.
    vkGetPhysicalDeviceProperties(device, &properties.properties);
    DeviceInfo info;
    info.name = properties.properties.deviceName;
    info.api_version = properties.properties.apiVersion;
    info.type = device_type(properties.properties.deviceType);
    if (info.api_version < VK_API_VERSION_1_3) {
        info.missing.push_back("Vulkan 1.3");
        return info;
    }
    vkGetPhysicalDeviceProperties2(device, &properties);
    info.driver = fmt::format("{} {}", v12.driverName, v12.driverInfo);
    info.subgroup_size = subgroup.subgroupSize;
    info.min_subgroup_size = sizes.minSubgroupSize;
    info.max_subgroup_size = sizes.maxSubgroupSize;
    info.max_allocation_bytes = limits.maxMemoryAllocationSize;
    info.shared_memory_bytes = properties.properties.limits.maxComputeSharedMemorySize;
    if (properties.properties.limits.timestampComputeAndGraphics)
        info.timestamp_period_ns = properties.properties.limits.timestampPeriod;
    info.loop_limit = loop_limit(v12);
    info.lockstep = v12.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
    info.persistent_workgroups = persistent_workgroups(info.type);
    info.has_ray_query = has_extension(device, VK_KHR_RAY_QUERY_EXTENSION_NAME);

    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            info.memory_bytes =
                std::max<std::uint64_t>(info.memory_bytes, memory.memoryHeaps[i].size);

    FeatureChain features(has_extension(device, VK_KHR_SHADER_CLOCK_EXTENSION_NAME));
    vkGetPhysicalDeviceFeatures2(device, &features.core);
    info.missing = features.missing();
    return info;
}

}  // namespace

const char* to_string(DeviceType type) {
    static constexpr const char* kNames[] = {"discrete", "integrated", "virtual", "cpu", "other"};
    return kNames[static_cast<int>(type)];
}

bool validation_installed() {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
}

VkInstance create_instance(bool validation) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "grove";
    application.apiVersion = VK_API_VERSION_1_3;
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    const char* layer = kValidationLayer;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validation) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        throw Error(result,
                    "no Vulkan driver found; install one (mesa-vulkan-drivers has a CPU device)");
    check(result, "vkCreateInstance");
    return instance;
}

std::vector<PhysicalDevice> enumerate(VkInstance instance) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance, &count, handles.data()),
          "vkEnumeratePhysicalDevices");
    std::vector<PhysicalDevice> devices;
    for (VkPhysicalDevice handle : handles) devices.push_back({handle, describe(handle)});
    std::stable_sort(devices.begin(), devices.end(),
                     [](const auto& a, const auto& b) { return a.info.type < b.info.type; });
    return devices;
}

std::vector<DeviceInfo> list_devices() {
    const VkInstance instance = create_instance(false);
    std::vector<DeviceInfo> infos;
    for (PhysicalDevice& device : enumerate(instance)) infos.push_back(std::move(device.info));
    vkDestroyInstance(instance, nullptr);
    return infos;
}

}  // namespace taskpool::gpu
