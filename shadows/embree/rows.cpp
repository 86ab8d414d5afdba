// What this folder adds to the registry of shadow methods.
#include <fmt/format.h>

#include "shadows/embree/embree.hpp"

namespace shadows::embree {
namespace {

using structures::Parameter;
using structures::Settings;

const std::vector<Parameter>& common_parameters() {
    static const std::vector<Parameter> parameters = {
        {"quality",
         std::string("medium"),
         "Embree's build quality; Embree 3.13 builds the same robust tree for all three",
         {"low", "medium", "high"}},
        {"bias",
         double{Config{}.bias},
         "fraction of the segment next to the receiver that is not searched",
         {},
         0,
         0.5},
        {"threads", std::int64_t{0}, "threads that build and trace (0: all cores)", {}, 0, 1024},
    };
    return parameters;
}

std::span<const Parameter> plain_parameters() { return common_parameters(); }

std::span<const Parameter> packet_parameters() {
    static const std::vector<Parameter> parameters = [] {
        std::vector<Parameter> all = common_parameters();
        all.push_back({"width",
                       std::int64_t{0},
                       "rays per packet, 8 or 16 (0: the faster on this host)",
                       {},
                       0,
                       16});
        return all;
    }();
    return parameters;
}

Config common_config(const Settings& settings) {
    Config config;
    config.quality = structures::embree::quality_from(settings.text("quality"));
    config.bias = static_cast<float>(settings.real("bias"));
    config.threads = static_cast<unsigned>(settings.integer("threads"));
    return config;
}

std::unique_ptr<Method> create_single(taskpool::gpu::Device&, const Settings& settings) {
    return std::make_unique<EmbreeMethod>(common_config(settings));
}

std::unique_ptr<Method> create_packet(taskpool::gpu::Device&, const Settings& settings) {
    Config config = common_config(settings);
    config.width = static_cast<std::uint32_t>(settings.integer("width"));
    if (config.width != 0 && config.width != 8 && config.width != 16)
        throw structures::SettingError(
            "width", fmt::format("'width' is {}; expected 8, 16, or 0", config.width));
    return std::make_unique<EmbreeMethod>(config);
}

std::unique_ptr<Method> create_stream(taskpool::gpu::Device&, const Settings& settings) {
    Config config = common_config(settings);
    config.width = 64;
    return std::make_unique<EmbreeMethod>(config);
}

}  // namespace

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"embree", "Intel Embree on the CPU, one shadow ray at a time", &plain_parameters,
         &create_single},
        {"embree_packet", "Intel Embree on the CPU, packets of 8 or 16 shadow rays",
         &packet_parameters, &create_packet},
        {"embree_stream", "Intel Embree on the CPU, coherent streams of 64 shadow rays",
         &plain_parameters, &create_stream},
    };
    return all;
}

}  // namespace shadows::embree
