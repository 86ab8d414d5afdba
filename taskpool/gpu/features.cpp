#include "taskpool/gpu/features.hpp"

namespace taskpool::gpu {
namespace {

/// Calls `visit(flag, name)` for each required feature.
template <typename Chain, typename Visit>
void for_each_required(Chain& f, const Visit& visit) {
    visit(f.core.features.shaderInt64, "shaderInt64");
    visit(f.core.features.shaderFloat64, "shaderFloat64");
    visit(f.core.features.geometryShader, "geometryShader (primitive id in fragment shaders)");
    visit(f.core.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
    visit(f.core.features.depthClamp, "depthClamp");
    visit(f.clock.shaderSubgroupClock, "shaderSubgroupClock");
    visit(f.clock.shaderDeviceClock, "shaderDeviceClock");
    visit(f.v12.bufferDeviceAddress, "bufferDeviceAddress");
    visit(f.v12.scalarBlockLayout, "scalarBlockLayout");
    visit(f.v12.vulkanMemoryModel, "vulkanMemoryModel");
    visit(f.v12.vulkanMemoryModelDeviceScope, "vulkanMemoryModelDeviceScope");
    visit(f.v12.hostQueryReset, "hostQueryReset");
    visit(f.v13.synchronization2, "synchronization2");
    visit(f.v13.dynamicRendering, "dynamicRendering");
    visit(f.v13.maintenance4, "maintenance4 (workgroup size by specialisation)");
    visit(f.v13.subgroupSizeControl, "subgroupSizeControl");
    visit(f.v13.computeFullSubgroups, "computeFullSubgroups");
}

}  // namespace

FeatureChain::FeatureChain(bool has_shader_clock) {
    core.pNext = &v11;
    v11.pNext = &v12;
    v12.pNext = &v13;
    v13.pNext = has_shader_clock ? &clock : nullptr;
}

void FeatureChain::require_all() {
    for_each_required(*this, [](VkBool32& flag, const char*) { flag = VK_TRUE; });
}

std::vector<std::string> FeatureChain::missing() const {
    std::vector<std::string> names;
    for_each_required(*this, [&](VkBool32 flag, const char* name) {
        if (!flag) names.emplace_back(name);
    });
    return names;
}

}  // namespace taskpool::gpu
