// A compute pipeline.
#pragma once

#include <bit>
#include <string>
#include <vector>

#include "taskpool/gpu/device.hpp"
#include "taskpool/gpu/shader.hpp"

namespace taskpool::gpu {

/// One specialisation constant: 32 bits for `constant_id = id`.
struct Constant {
    std::uint32_t id;
    std::uint32_t bits;
    Constant(std::uint32_t constant_id, std::uint32_t value) : id(constant_id), bits(value) {}
    Constant(std::uint32_t constant_id, int value) : id(constant_id), bits(std::uint32_t(value)) {}
    Constant(std::uint32_t constant_id, bool value) : id(constant_id), bits(value ? 1 : 0) {}
    Constant(std::uint32_t constant_id, float value)
        : id(constant_id), bits(std::bit_cast<std::uint32_t>(value)) {}
};

/// Move-only. Constant 0 is the subgroup size and set by the kernel itself: shaders declare
/// `layout(local_size_x_id = 0) in;` and run one full subgroup per workgroup.
class Kernel {
  public:
    Kernel() = default;
    Kernel(Device& device, const Shader& shader, const std::vector<Constant>& constants = {});
    ~Kernel();
    Kernel(Kernel&& other) noexcept { swap(other); }
    Kernel& operator=(Kernel&& other) noexcept {
        swap(other);
        return *this;
    }

    VkPipeline handle() const { return pipeline_; }
    /// The shader's path.
    const std::string& name() const { return name_; }

  private:
    void swap(Kernel& other) noexcept;

    Device* device_ = nullptr;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    std::string name_;
};

/// The shader module of `shader` (from DeviceOptions::shader_source if that has it); the caller
/// destroys it.
VkShaderModule create_module(Device& device, const Shader& shader);

}  // namespace taskpool::gpu
