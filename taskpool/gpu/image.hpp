// Images that are rendered to: colour and depth targets. They are read back, and read by kernels,
// through a copy into a buffer.
//
//     Image ids(device, VK_FORMAT_R32_UINT, 1920, 1080, "ids");
//     Image depth(device, VK_FORMAT_D32_SFLOAT, 1920, 1080, "depth");
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "taskpool/gpu/device.hpp"

namespace taskpool::gpu {

/// Move-only. Two dimensions, one level, one layer, one sample, on the device; a format with depth
/// makes a depth target, any other a colour target.
class Image {
  public:
    Image() = default;
    /// Throws std::invalid_argument if a side is 0, Error naming the image if the device cannot
    /// render to this format or size, or memory does not suffice.
    Image(Device& device, VkFormat format, std::uint32_t width, std::uint32_t height,
          std::string name);
    ~Image();
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        swap(other);
        return *this;
    }

    VkImage handle() const { return image_; }
    VkImageView view() const { return view_; }
    VkFormat format() const { return format_; }
    /// What the format holds: colour, or depth (and stencil).
    VkImageAspectFlags aspects() const;
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    const std::string& name() const { return name_; }

  private:
    void create(Device& device);
    void destroy();
    void swap(Image& other) noexcept;

    Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    std::uint32_t width_ = 0, height_ = 0;
    std::size_t allocated_ = 0;
    std::string name_;
};

/// The aspects of a format: depth, depth and stencil, or colour.
VkImageAspectFlags aspects_of(VkFormat format);

}  // namespace taskpool::gpu
