#include "taskpool/gpu/recorder.hpp"

#include <stdexcept>

namespace taskpool::gpu {

Recorder::Recorder(Device& device) : device_(device) {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = device.command_pool();
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &info, &commands_), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
}

Recorder::~Recorder() {
    vkFreeCommandBuffers(device_.handle(), device_.command_pool(), 1, &commands_);
}

void Recorder::prepare(const Kernel& kernel, const void* push, std::uint32_t bytes) {
    if (breadcrumbs_.size() == 0) {
        const std::uint32_t none = 0;
        breadcrumbs_ = Buffer(device_, sizeof(none), "breadcrumbs", Buffer::Place::host);
        breadcrumbs_.write(&none, sizeof(none));
    }
    kernels_.push_back(kernel.name());
    vkCmdFillBuffer(commands_, breadcrumbs_.handle(), 0, 4, std::uint32_t(kernels_.size()));
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.handle());
    if (bytes) vkCmdPushConstants(commands_, device_.layout(), VK_SHADER_STAGE_ALL, 0, bytes, push);
}

void Recorder::record_dispatch(const Kernel& kernel, const void* push, std::uint32_t bytes,
                               std::uint32_t groups_x, std::uint32_t groups_y) {
    if (groups_x == 0 || groups_y == 0) return;
    prepare(kernel, push, bytes);
    vkCmdDispatch(commands_, groups_x, groups_y, 1);
}

void Recorder::record_indirect(const Kernel& kernel, const void* push, std::uint32_t bytes,
                               const Buffer& arguments, std::size_t offset) {
    prepare(kernel, push, bytes);
    vkCmdDispatchIndirect(commands_, arguments.handle(), offset);
}

void Recorder::barrier() {
    VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask =
        VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(commands_, &info);
}

void Recorder::fill(const Buffer& buffer, std::uint32_t word, std::size_t offset,
                    std::size_t bytes) {
    if (offset >= buffer.size()) return;
    vkCmdFillBuffer(commands_, buffer.handle(), offset, bytes ? bytes : VK_WHOLE_SIZE, word);
}

void Recorder::copy(const Buffer& source, const Buffer& target, std::size_t bytes,
                    std::size_t source_offset, std::size_t target_offset) {
    if (bytes == 0) return;
    const VkBufferCopy region{source_offset, target_offset, bytes};
    vkCmdCopyBuffer(commands_, source.handle(), target.handle(), 1, &region);
}

void Recorder::timestamp(Timestamps& timestamps, std::string label) {
    if (timestamps.labels_.size() == timestamps.capacity())
        throw std::logic_error("timestamp '" + label + "' exceeds the query pool's capacity");
    const auto slot = std::uint32_t(timestamps.labels_.size());
    if (slot == 0) vkCmdResetQueryPool(commands_, timestamps.handle(), 0, timestamps.capacity());
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps.handle(),
                         slot);
    timestamps.labels_.push_back(std::move(label));
}

std::string Recorder::running_kernel() const {
    std::uint32_t started = 0;
    if (breadcrumbs_.size()) breadcrumbs_.read(&started, sizeof(started));
    return started == 0 || started > kernels_.size() ? std::string() : kernels_[started - 1];
}

}  // namespace taskpool::gpu
