// grove doctor: what this machine offers, and what to do about what it does not.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "experiments/commands/program.hpp"
#include "experiments/measure/provenance.hpp"

namespace experiments::commands {
namespace {

using taskpool::gpu::DeviceInfo;

void line(const char* state, const std::string& text) { fmt::print("{:<8} {}\n", state, text); }

std::string gib(std::uint64_t bytes) {
    return fmt::format("{:.1f} GiB", double(bytes) / (1u << 30));
}

/// True if an executable of that name is on the search path.
bool on_path(const std::string& program) {
    const char* variable = std::getenv("PATH");
    std::string_view path = variable ? variable : "";
    while (!path.empty()) {
        const std::size_t end = std::min(path.find(':'), path.size());
        const std::string file = std::string(path.substr(0, end)) + "/" + program;
        if (::access(file.c_str(), X_OK) == 0) return true;
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return false;
}

void describe(const DeviceInfo& device, std::size_t index) {
    line(device.usable() ? "ok" : "missing",
         fmt::format("device {}: {} ({}), {}", index, device.name, to_string(device.type),
                     device.driver));
    line("", fmt::format(
                 "Vulkan {}.{}, subgroups of {}, {} memory, buffers up to {}, {} KiB shared",
                 VK_API_VERSION_MAJOR(device.api_version), VK_API_VERSION_MINOR(device.api_version),
                 device.subgroup_size, gib(device.memory_bytes), gib(device.max_allocation_bytes),
                 device.shared_memory_bytes / 1024));
    line("", fmt::format("timestamps {}, ray query {}, {} persistent workgroups",
                         device.timestamp_period_ns > 0 ? "yes" : "no",
                         device.has_ray_query ? "yes" : "no", device.persistent_workgroups));
    for (const std::string& feature : device.missing)
        line("", fmt::format("lacks {}: update the driver, or choose another --device", feature));
    if (device.loop_limit > 0)
        line("warning", fmt::format("this driver cuts shader loops after {} rounds; grove works "
                                    "around it, slower: install mesa-vulkan-drivers 23 or later "
                                    "(bookworm-backports has it)",
                                    device.loop_limit));
}

/// True if there is a device to run on.
bool check_devices() {
    std::vector<DeviceInfo> devices;
    try {
        devices = taskpool::gpu::list_devices();
    } catch (const taskpool::gpu::Error& error) {
        line("missing",
             fmt::format("Vulkan: {}; install libvulkan1 and mesa-vulkan-drivers", error.what()));
        return false;
    }
    bool usable = false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        describe(devices[i], i);
        usable = usable || devices[i].usable();
    }
    if (!usable)
        line("missing",
             "a usable Vulkan device: install mesa-vulkan-drivers, which has one that "
             "runs on the CPU");
    return usable;
}

}  // namespace

int doctor(const measure::Registries& registries) {
    const auto host = measure::host_provenance();
    line("ok", fmt::format("host: {}, {} cores, {}", host.at("cpu").get<std::string>(),
                           host.at("cores").get<int>(),
                           gib(host.at("memory_bytes").get<std::uint64_t>())));
    const bool usable = check_devices();
    line("ok", fmt::format("{} structures, {} shadow methods", registries.structures.size(),
                           registries.methods.size()));
    if (::access(".", W_OK) == 0)
        line("ok", "the working directory can be written");
    else
        line("missing", "the working directory cannot be written: pass --out to grove run");
    if (on_path("git"))
        line("ok", "git: the manifest names the commit");
    else
        line("warning",
             "git is not installed: the manifest names the commit of the last configure");
    if (on_path("chromium"))
        line("ok", "chromium: the test of the report can run");
    else
        line("warning", "chromium is not installed: the test of the report is skipped");
    if (!usable) throw std::runtime_error("no usable Vulkan device: see the lines above");
    return 0;
}

}  // namespace experiments::commands
