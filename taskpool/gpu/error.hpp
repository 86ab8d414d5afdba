// Errors of the Vulkan runtime.
#pragma once

#include <vulkan/vulkan_core.h>

#include <source_location>
#include <stdexcept>
#include <string>

namespace taskpool::gpu {

/// A Vulkan call failed, or the device cannot do what is asked. what() is one line.
struct Error : std::runtime_error {
    Error(VkResult code, const std::string& message) : std::runtime_error(message), result(code) {}
    VkResult result;
};

/// "VK_ERROR_DEVICE_LOST" and the like.
const char* result_name(VkResult result);

/// Throws Error naming `what` and the calling line unless `result` is a success code.
void check(VkResult result, const char* what,
           std::source_location where = std::source_location::current());

}  // namespace taskpool::gpu
