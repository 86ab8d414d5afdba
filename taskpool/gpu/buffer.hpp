// Device memory reached by address; no descriptors anywhere.
//
//     Buffer input = make_buffer<float>(device, values, "input");
//     Buffer output(device, bytes, "output");
//     std::vector<float> result = read<float>(output, count);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "taskpool/gpu/device.hpp"

namespace taskpool::gpu {

/// Move-only. Its memory lives on the device; it is mapped too where the device allows that at no
/// cost (CPU and integrated devices), and read and written through a staging buffer elsewhere.
class Buffer {
  public:
    enum class Place { device, host };  ///< host: mapped, for staging and read-back

    Buffer() = default;
    /// `bytes` may be 0: the buffer then holds 16 bytes. Throws Error naming buffer and size when
    /// memory does not suffice.
    Buffer(Device& device, std::size_t bytes, std::string name, Place place = Place::device);
    ~Buffer();
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }

    std::uint64_t address() const { return address_; }
    std::size_t size() const { return size_; }
    VkBuffer handle() const { return buffer_; }
    const std::string& name() const { return name_; }

    /// Copies host bytes in or out; waits. Throws std::out_of_range beyond the end.
    void write(const void* source, std::size_t bytes, std::size_t offset = 0);
    void read(void* target, std::size_t bytes, std::size_t offset = 0) const;

  private:
    void swap(Buffer& other) noexcept;
    void check_range(std::size_t bytes, std::size_t offset) const;

    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::uint64_t address_ = 0;
    std::size_t size_ = 0, allocated_ = 0;
    void* mapped_ = nullptr;
    std::string name_;
};

/// A buffer holding a copy of `values`.
template <typename T>
Buffer make_buffer(Device& device, std::span<const T> values, std::string name) {
    Buffer buffer(device, values.size_bytes(), std::move(name));
    buffer.write(values.data(), values.size_bytes());
    return buffer;
}

/// `count` values from the buffer, `first` values after its start.
template <typename T>
std::vector<T> read(const Buffer& buffer, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    buffer.read(values.data(), count * sizeof(T), first * sizeof(T));
    return values;
}

}  // namespace taskpool::gpu
