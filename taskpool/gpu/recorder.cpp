#include "taskpool/gpu/recorder.hpp"

#include <algorithm>
#include <stdexcept>

namespace taskpool::gpu {
namespace {

/// Kernels of one recording that are told apart when the device is lost.
constexpr std::size_t kBreadcrumbs = 1024;

}  // namespace

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

void Recorder::leave_breadcrumb(const std::string& name) {
    if (breadcrumbs_.size() == 0) {
        const std::vector<std::uint32_t> none(kBreadcrumbs, 0);
        breadcrumbs_ = Buffer(device_, kBreadcrumbs * 4, "breadcrumbs", Buffer::Place::host);
        breadcrumbs_.write(none.data(), kBreadcrumbs * 4);
    }
    // A word of its own for each: kernels without a barrier between them must not race here.
    if (kernels_.size() < kBreadcrumbs)
        vkCmdFillBuffer(commands_, breadcrumbs_.handle(), kernels_.size() * 4, 4, 1);
    kernels_.push_back(name);
}

void Recorder::prepare(const Kernel& kernel, const void* push, std::uint32_t bytes) {
    leave_breadcrumb(kernel.name());
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

void Recorder::move_targets(VkImageLayout from, VkImageLayout to) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const Image* image : targets_) {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.oldLayout = from;
        barrier.newLayout = to;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image->handle();
        barrier.subresourceRange = {image->aspects(), 0, 1, 0, 1};
        barriers.push_back(barrier);
    }
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = std::uint32_t(barriers.size());
    info.pImageMemoryBarriers = barriers.data();
    vkCmdPipelineBarrier2(commands_, &info);
}

void Recorder::begin_rendering(const std::string& name, const RenderTargets& targets) {
    leave_breadcrumb(name);
    for (const RenderTargets::Color& color : targets.colors) targets_.push_back(color.image);
    if (targets.depth) targets_.push_back(targets.depth);
    if (targets_.empty()) throw std::logic_error("rendering '" + name + "' has no target");
    move_targets(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL);

    VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    attachment.imageLayout = VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const RenderTargets::Color& color : targets.colors) {
        colors.push_back(attachment);
        colors.back().imageView = color.image->view();
        colors.back().clearValue.color = color.clear;
    }
    const VkRect2D area{{0, 0}, {targets_[0]->width(), targets_[0]->height()}};
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = area;
    info.layerCount = 1;
    info.colorAttachmentCount = std::uint32_t(colors.size());
    info.pColorAttachments = colors.data();
    if (targets.depth) {
        attachment.imageView = targets.depth->view();
        attachment.clearValue.depthStencil = {targets.clear_depth, 0};
        info.pDepthAttachment = &attachment;
        if (targets.depth->aspects() & VK_IMAGE_ASPECT_STENCIL_BIT)
            info.pStencilAttachment = &attachment;
    }
    vkCmdBeginRendering(commands_, &info);
    const VkViewport viewport{0, 0, float(area.extent.width), float(area.extent.height), 0, 1};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &area);
}

void Recorder::record_draw(const RasterPipeline& pipeline, const void* push, std::uint32_t bytes,
                           std::uint32_t vertex_count) {
    if (vertex_count == 0) return;
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle());
    vkCmdPushConstants(commands_, device_.layout(), VK_SHADER_STAGE_ALL, 0, bytes, push);
    vkCmdDraw(commands_, vertex_count, 1, 0, 0);
}

void Recorder::end_rendering() {
    vkCmdEndRendering(commands_);
    move_targets(VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    targets_.clear();
}

void Recorder::copy(const Image& source, VkImageAspectFlagBits aspect, const Buffer& target,
                    std::size_t offset) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {VkImageAspectFlags(aspect), 0, 0, 1};
    region.imageExtent = {source.width(), source.height(), 1};
    vkCmdCopyImageToBuffer(commands_, source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           target.handle(), 1, &region);
}

std::string Recorder::running_kernel() const {
    if (kernels_.empty()) return {};
    const std::vector<std::uint32_t> started = read<std::uint32_t>(breadcrumbs_, kBreadcrumbs);
    const auto last = std::find(started.rbegin(), started.rend(), 1u);
    return last == started.rend() ? std::string()
                                  : kernels_[std::size_t(started.rend() - last) - 1];
}

}  // namespace taskpool::gpu
