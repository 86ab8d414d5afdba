#include "taskpool/gpu/raster_pipeline.hpp"

#include "taskpool/gpu/image.hpp"

namespace taskpool::gpu {
namespace {

VkPipelineDepthStencilStateCreateInfo depth_state(const RasterOptions& options) {
    VkPipelineDepthStencilStateCreateInfo state{
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    state.depthTestEnable = options.depth_format != VK_FORMAT_UNDEFINED;
    state.depthWriteEnable = options.depth_write;
    state.depthCompareOp = options.depth_compare;
    return state;
}

VkPipelineRasterizationStateCreateInfo raster_state(const RasterOptions& options) {
    VkPipelineRasterizationStateCreateInfo state{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    state.depthClampEnable = options.depth_clamp;
    state.polygonMode = VK_POLYGON_MODE_FILL;
    state.cullMode = options.cull;
    state.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    state.depthBiasEnable = options.depth_bias_constant != 0 || options.depth_bias_slope != 0;
    state.depthBiasConstantFactor = options.depth_bias_constant;
    state.depthBiasSlopeFactor = options.depth_bias_slope;
    state.lineWidth = 1;
    return state;
}

}  // namespace

RasterPipeline::RasterPipeline(Device& device, const Shader& vertex, const Shader& fragment,
                               const RasterOptions& options)
    : device_(&device) {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    for (const Constant& constant : options.constants) {
        entries.push_back({constant.id, std::uint32_t(values.size() * 4), sizeof(std::uint32_t)});
        values.push_back(constant.bits);
    }
    const VkSpecializationInfo specialization{std::uint32_t(entries.size()), entries.data(),
                                              values.size() * 4, values.data()};

    VkPipelineVertexInputStateCreateInfo no_vertices{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = raster_state(options);
    VkPipelineMultisampleStateCreateInfo samples{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const VkPipelineDepthStencilStateCreateInfo depth = depth_state(options);
    VkPipelineColorBlendAttachmentState write_all{};
    write_all.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const std::vector<VkPipelineColorBlendAttachmentState> targets(options.color_formats.size(),
                                                                   write_all);
    VkPipelineColorBlendStateCreateInfo blend{
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = std::uint32_t(targets.size());
    blend.pAttachments = targets.data();
    const VkDynamicState dynamic[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamics{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamics.dynamicStateCount = std::size(dynamic);
    dynamics.pDynamicStates = dynamic;

    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = std::uint32_t(options.color_formats.size());
    rendering.pColorAttachmentFormats = options.color_formats.data();
    rendering.depthAttachmentFormat = options.depth_format;
    if (aspects_of(options.depth_format) & VK_IMAGE_ASPECT_STENCIL_BIT)
        rendering.stencilAttachmentFormat = options.depth_format;

    VkPipelineShaderStageCreateInfo stages[2]{};
    const auto destroy_modules = [&] {
        for (const VkPipelineShaderStageCreateInfo& stage : stages)
            vkDestroyShaderModule(device.handle(), stage.module, nullptr);
    };
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = std::size(stages);
    info.pStages = stages;
    info.pVertexInputState = &no_vertices;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamics;
    info.layout = device.layout();
    try {
        for (int i = 0; i < 2; ++i) {
            stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
            stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
            stages[i].module = create_module(device, i == 0 ? vertex : fragment);
            stages[i].pName = "main";
            stages[i].pSpecializationInfo = &specialization;
        }
        check(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr,
                                        &pipeline_),
              ("compiling " + std::string(vertex.path)).c_str());
    } catch (...) {
        destroy_modules();
        throw;
    }
    destroy_modules();
    device.name_object(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_),
                       std::string(vertex.path));
}

RasterPipeline::~RasterPipeline() {
    if (device_) vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
}

void RasterPipeline::swap(RasterPipeline& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pipeline_, other.pipeline_);
}

}  // namespace taskpool::gpu
