#include "taskpool/gpu/image.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace taskpool::gpu {

VkImageAspectFlags aspects_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        case VK_FORMAT_D16_UNORM_S8_UINT:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

VkImageAspectFlags Image::aspects() const { return aspects_of(format_); }

Image::Image(Device& device, VkFormat format, std::uint32_t width, std::uint32_t height,
             std::string name)
    : format_(format), width_(width), height_(height), name_(std::move(name)) {
    if (width == 0 || height == 0)
        throw std::invalid_argument(fmt::format(
            "image '{}' of {} x {} pixels: both sides must be at least 1", name_, width, height));
    device_ = &device;
    try {
        create(device);
    } catch (...) {
        destroy();
        throw;
    }
    device.count_allocation(static_cast<std::int64_t>(allocated_));
}

void Image::create(Device& device) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format_;
    info.extent = {width_, height_, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
        (aspects() & VK_IMAGE_ASPECT_COLOR_BIT ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT
                                               : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    VkImageFormatProperties limits{};
    const VkResult supported = vkGetPhysicalDeviceImageFormatProperties(
        device.physical(), format_, info.imageType, info.tiling, info.usage, info.flags, &limits);
    if (supported != VK_SUCCESS || width_ > limits.maxExtent.width ||
        height_ > limits.maxExtent.height)
        throw Error(VK_ERROR_FORMAT_NOT_SUPPORTED,
                    fmt::format("image '{}': '{}' renders to no image of {} x {} pixels in format "
                                "{} (largest: {} x {})",
                                name_, device.info().name, width_, height_, int(format_),
                                limits.maxExtent.width, limits.maxExtent.height));
    check(vkCreateImage(device.handle(), &info, nullptr, &image_), "vkCreateImage");

    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device.handle(), image_, &requirements);
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = requirements.size;
    allocation.memoryTypeIndex =
        device.memory_type(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    const VkResult result = vkAllocateMemory(device.handle(), &allocation, nullptr, &memory_);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw Error(result, fmt::format("no memory for image '{}' of {} x {} pixels ({} MiB) on "
                                        "'{}' ({} MiB in use)",
                                        name_, width_, height_, requirements.size >> 20,
                                        device.info().name, device.allocated_bytes() >> 20));
    check(result, "vkAllocateMemory");
    check(vkBindImageMemory(device.handle(), image_, memory_, 0), "vkBindImageMemory");

    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_;
    view.subresourceRange = {aspects(), 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &view, nullptr, &view_), "vkCreateImageView");
    device.name_object(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image_), name_);
    allocated_ = requirements.size;
}

void Image::destroy() {
    vkDestroyImageView(device_->handle(), view_, nullptr);
    vkDestroyImage(device_->handle(), image_, nullptr);
    vkFreeMemory(device_->handle(), memory_, nullptr);
}

Image::~Image() {
    if (!device_) return;
    destroy();
    device_->count_allocation(-static_cast<std::int64_t>(allocated_));
}

void Image::swap(Image& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(memory_, other.memory_);
    std::swap(view_, other.view_);
    std::swap(format_, other.format_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    std::swap(allocated_, other.allocated_);
    std::swap(name_, other.name_);
}

}  // namespace taskpool::gpu
