// The Vulkan devices of this machine, best first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace taskpool::gpu {

enum class DeviceType { discrete, integrated, virtual_gpu, cpu, other };
const char* to_string(DeviceType type);

struct DeviceInfo {
    std::string name;
    std::string driver;  ///< driver name and version, e.g. "llvmpipe Mesa 25.0.7"
    DeviceType type = DeviceType::other;
    std::uint32_t api_version = 0;    ///< VK_MAKE_API_VERSION encoding
    std::uint32_t subgroup_size = 0;  ///< what kernels run with
    std::uint32_t min_subgroup_size = 0, max_subgroup_size = 0;
    std::uint64_t memory_bytes = 0;          ///< size of the largest device-local heap
    std::uint64_t max_allocation_bytes = 0;  ///< of one buffer
    std::uint32_t shared_memory_bytes = 0;   ///< per workgroup
    double timestamp_period_ns = 0;          ///< 0: no timestamps
    std::vector<std::string> missing;        ///< required features that it lacks; usable if empty
    bool has_ray_query = false;
    /// Iterations after which the driver silently cuts a shader's loops, summed over one
    /// invocation; 0 if it does not. Mesa's llvmpipe before version 23 stops at 65,535.
    std::uint32_t loop_limit = 0;
    bool lockstep = false;  ///< the lanes of a subgroup are one vector: Mesa's llvmpipe
    /// Workgroups of one subgroup that run at the same time and are worth keeping persistent.
    std::uint32_t persistent_workgroups = 1;

    bool usable() const { return missing.empty(); }
};

/// Discrete GPUs first, then integrated, virtual and CPU devices; the index into this list is what
/// `--device` takes. Throws Error if Vulkan itself cannot be started.
std::vector<DeviceInfo> list_devices();

}  // namespace taskpool::gpu
