#include "taskpool/gpu/buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "taskpool/gpu/recorder.hpp"

namespace taskpool::gpu {
namespace {

constexpr VkMemoryPropertyFlags kMappable =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr std::size_t kStagingBytes = std::size_t{64} << 20;

/// Device-local memory, mappable only where that costs nothing: a discrete GPU's mappable window is
/// small or slow to read.
VkMemoryPropertyFlags wanted_memory(const Device& device, Buffer::Place place) {
    const DeviceType type = device.info().type;
    if (place == Buffer::Place::host) return kMappable | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    if (type == DeviceType::cpu || type == DeviceType::integrated)
        return kMappable | VK_MEMORY_PROPERTY_HOST_CACHED_BIT | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
}

std::uint32_t find_memory(const Device& device, std::uint32_t allowed, Buffer::Place place) {
    const VkMemoryPropertyFlags wanted = wanted_memory(device, place);
    for (VkMemoryPropertyFlags optional :
         {VkMemoryPropertyFlags{0}, VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_HOST_CACHED_BIT}}) {
        try {
            return device.memory_type(allowed, wanted & ~optional);
        } catch (const Error&) {
        }
    }
    return device.memory_type(allowed,
                              place == Buffer::Place::host
                                  ? kMappable
                                  : VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT});
}

}  // namespace

Buffer::Buffer(Device& device, std::size_t bytes, std::string name, Place place)
    : device_(&device), size_(bytes), name_(std::move(name)) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = std::max<std::size_t>((bytes + 15) / 16 * 16, 16);
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                 VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    const auto out_of_memory = [&] {
        const DeviceInfo& limits = device.info();
        return fmt::format(
            "no memory for buffer '{}' of {} MiB on '{}' ({} MiB in use, device has {} MiB, one "
            "buffer holds at most {} MiB)",
            name_, info.size >> 20, limits.name, device.allocated_bytes() >> 20,
            limits.memory_bytes >> 20, limits.max_allocation_bytes >> 20);
    };
    if (info.size > device.info().max_allocation_bytes)
        throw Error(VK_ERROR_OUT_OF_DEVICE_MEMORY, out_of_memory());
    check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), "vkCreateBuffer");

    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle(), buffer_, &requirements);
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
    allocation.allocationSize = requirements.size;
    try {
        allocation.memoryTypeIndex = find_memory(device, requirements.memoryTypeBits, place);
        const VkResult result = vkAllocateMemory(device.handle(), &allocation, nullptr, &memory_);
        if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
            throw Error(result, out_of_memory());
        check(result, "vkAllocateMemory");
        check(vkBindBufferMemory(device.handle(), buffer_, memory_, 0), "vkBindBufferMemory");
        if (device.memory_flags(allocation.memoryTypeIndex) & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
            check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_),
                  "vkMapMemory");
    } catch (...) {
        vkFreeMemory(device.handle(), memory_, nullptr);
        vkDestroyBuffer(device.handle(), buffer_, nullptr);
        throw;
    }
    allocated_ = requirements.size;
    device.count_allocation(static_cast<std::int64_t>(allocated_));
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = buffer_;
    address_ = vkGetBufferDeviceAddress(device.handle(), &address);
    device.name_object(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer_), name_);
}

Buffer::~Buffer() {
    if (!device_) return;
    vkDestroyBuffer(device_->handle(), buffer_, nullptr);
    vkFreeMemory(device_->handle(), memory_, nullptr);
    device_->count_allocation(-static_cast<std::int64_t>(allocated_));
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(address_, other.address_);
    std::swap(size_, other.size_);
    std::swap(allocated_, other.allocated_);
    std::swap(mapped_, other.mapped_);
    std::swap(name_, other.name_);
}

void Buffer::check_range(std::size_t bytes, std::size_t offset) const {
    if (offset > size_ || bytes > size_ - offset)
        throw std::out_of_range(fmt::format("buffer '{}' holds {} bytes: no {} bytes at {}", name_,
                                            size_, bytes, offset));
}

void Buffer::write(const void* source, std::size_t bytes, std::size_t offset) {
    check_range(bytes, offset);
    if (bytes == 0) return;
    if (mapped_) {
        std::memcpy(static_cast<char*>(mapped_) + offset, source, bytes);
        return;
    }
    Buffer staging(*device_, std::min(bytes, kStagingBytes), "staging", Place::host);
    for (std::size_t done = 0; done < bytes; done += kStagingBytes) {
        const std::size_t part = std::min(kStagingBytes, bytes - done);
        staging.write(static_cast<const char*>(source) + done, part);
        Recorder recorder(*device_);
        recorder.copy(staging, *this, part, 0, offset + done);
        recorder.barrier();
        device_->run(recorder);
    }
}

void Buffer::read(void* target, std::size_t bytes, std::size_t offset) const {
    check_range(bytes, offset);
    if (bytes == 0) return;
    if (mapped_) {
        std::memcpy(target, static_cast<const char*>(mapped_) + offset, bytes);
        return;
    }
    Buffer staging(*device_, std::min(bytes, kStagingBytes), "staging", Place::host);
    for (std::size_t done = 0; done < bytes; done += kStagingBytes) {
        const std::size_t part = std::min(kStagingBytes, bytes - done);
        Recorder recorder(*device_);
        recorder.copy(*this, staging, part, offset + done, 0);
        recorder.barrier();
        device_->run(recorder);
        staging.read(static_cast<char*>(target) + done, part);
    }
}

}  // namespace taskpool::gpu
