#include "taskpool/gpu/device.hpp"

#include <fmt/format.h>

#include "taskpool/gpu/features.hpp"
#include "taskpool/gpu/instance.hpp"
#include "taskpool/gpu/recorder.hpp"

namespace taskpool::gpu {
namespace {

template <typename Function>
Function load(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* user) {
    const auto& options = *static_cast<const DeviceOptions*>(user);
    if (options.on_validation_message) options.on_validation_message(data->pMessage);
    return VK_FALSE;
}

/// The compute queue family; prefers one with graphics, which rasterisation needs.
std::uint32_t find_queue_family(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (VkQueueFlags wanted :
         {VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT, VK_QUEUE_COMPUTE_BIT + 0})
        for (std::uint32_t i = 0; i < count; ++i)
            if ((families[i].queueFlags & wanted) == wanted) return i;
    throw Error(VK_ERROR_FEATURE_NOT_PRESENT, "the device has no compute queue");
}

}  // namespace

Device::Device(DeviceOptions options) : options_(std::move(options)) {
    try {
        create_instance();
        create_device();
    } catch (...) {
        this->~Device();
        throw;
    }
}

Device::~Device() {
    if (device_) {
        vkDestroyFence(device_, fence_, nullptr);
        vkDestroyPipelineLayout(device_, layout_, nullptr);
        vkDestroyCommandPool(device_, command_pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_)
        load<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
    device_ = VK_NULL_HANDLE;
    messenger_ = VK_NULL_HANDLE;
    instance_ = VK_NULL_HANDLE;
}

void Device::create_instance() {
    const bool validation = options_.validation && validation_installed();
    instance_ = gpu::create_instance(validation);
    if (!validation) return;
    VkDebugUtilsMessengerCreateInfoEXT info{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = &options_;
    check(load<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT")(
              instance_, &info, nullptr, &messenger_),
          "vkCreateDebugUtilsMessengerEXT");
}

void Device::create_device() {
    std::vector<PhysicalDevice> devices = enumerate(instance_);
    if (devices.empty())
        throw Error(VK_ERROR_INITIALIZATION_FAILED,
                    "no Vulkan device found; install mesa-vulkan-drivers for a CPU device");
    std::size_t chosen = 0;
    if (options_.index >= 0) {
        chosen = static_cast<std::size_t>(options_.index);
        if (chosen >= devices.size())
            throw Error(VK_ERROR_INITIALIZATION_FAILED,
                        fmt::format("no device {}: this machine has devices 0 to {}", chosen,
                                    devices.size() - 1));
    } else {
        while (chosen + 1 < devices.size() && !devices[chosen].info.usable()) ++chosen;
    }
    physical_ = devices[chosen].handle;
    info_ = devices[chosen].info;
    if (!info_.usable())
        throw Error(VK_ERROR_FEATURE_NOT_PRESENT, fmt::format("device '{}' lacks {}", info_.name,
                                                              fmt::join(info_.missing, ", ")));
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

    const float priority = 1;
    const std::uint32_t family = find_queue_family(physical_);
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    FeatureChain features;
    features.require_all();
    const char* clock_extension = VK_KHR_SHADER_CLOCK_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &clock_extension;
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, family, 0, &queue_);

    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = family;
    check(vkCreateCommandPool(device_, &pool, nullptr, &command_pool_), "vkCreateCommandPool");

    VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, kPushBytes};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &range;
    check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");

    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device_, &fence, nullptr, &fence_), "vkCreateFence");
}

void Device::run(Recorder& recorder) {
    check(vkEndCommandBuffer(recorder.handle()), "vkEndCommandBuffer");
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = recorder.handle();
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check(vkResetFences(device_, 1, &fence_), "vkResetFences");
    VkResult result = vkQueueSubmit2(queue_, 1, &submit, fence_);
    if (result == VK_SUCCESS) result = vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX);
    if (result == VK_ERROR_DEVICE_LOST)
        throw Error(result, device_lost_message(info_.name, recorder.running_kernel()));
    check(result, "vkQueueSubmit2");
}

std::string device_lost_message(const std::string& device, const std::string& kernel) {
    return fmt::format(
        "device '{}' was lost while running {}; the driver's time limit may be too short for it: "
        "lower the launch budget, or look into the system log",
        device, kernel.empty() ? "a transfer" : "kernel " + kernel);
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted)
            return i;
    throw Error(VK_ERROR_FEATURE_NOT_PRESENT, "the device has no suitable memory type");
}

VkMemoryPropertyFlags Device::memory_flags(std::uint32_t type) const {
    return memory_.memoryTypes[type].propertyFlags;
}

void Device::name_object(VkObjectType type, std::uint64_t object, const std::string& name) const {
    if (!messenger_) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    load<PFN_vkSetDebugUtilsObjectNameEXT>(instance_, "vkSetDebugUtilsObjectNameEXT")(device_,
                                                                                      &info);
}

void Device::count_allocation(std::int64_t bytes) {
    const std::uint64_t now = allocated_ += static_cast<std::uint64_t>(bytes);
    std::uint64_t peak = peak_;
    while (now > peak && !peak_.compare_exchange_weak(peak, now)) {
    }
}

}  // namespace taskpool::gpu
