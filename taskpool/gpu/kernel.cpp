#include "taskpool/gpu/kernel.hpp"

#include <utility>

namespace taskpool::gpu {
namespace {

/// kLockstep in device.glsl.
constexpr std::uint32_t kLockstepConstant = 100;

}  // namespace

VkShaderModule create_module(Device& device, const Shader& shader) {
    std::optional<std::vector<std::uint32_t>> replacement;
    if (device.options().shader_source) replacement = device.options().shader_source(shader.path);
    const std::span<const std::uint32_t> code = replacement ? *replacement : shader.code;
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "vkCreateShaderModule");
    return module;
}

Kernel::Kernel(Device& device, const Shader& shader, const std::vector<Constant>& constants)
    : device_(&device), name_(shader.path) {
    std::vector<std::uint32_t> values{device.subgroup_size()};
    std::vector<VkSpecializationMapEntry> entries{{0, 0, sizeof(std::uint32_t)}};
    std::vector<Constant> all{{kLockstepConstant, device.info().lockstep}};
    all.insert(all.end(), constants.begin(), constants.end());
    for (const Constant& constant : all) {
        entries.push_back({constant.id, std::uint32_t(values.size() * 4), sizeof(std::uint32_t)});
        values.push_back(constant.bits);
    }
    const VkSpecializationInfo specialization{std::uint32_t(entries.size()), entries.data(),
                                              values.size() * 4, values.data()};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
    size.requiredSubgroupSize = device.subgroup_size();
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.layout = device.layout();
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.pNext = device.requires_subgroup_size() ? &size : nullptr;
    info.stage.flags = VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = create_module(device, shader);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    const VkResult result =
        vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
    check(result, ("compiling kernel " + name_).c_str());
    device.name_object(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name_);
}

Kernel::~Kernel() {
    if (device_) vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
}

void Kernel::swap(Kernel& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pipeline_, other.pipeline_);
    std::swap(name_, other.name_);
}

}  // namespace taskpool::gpu
