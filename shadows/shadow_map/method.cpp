// The shadow map as a shadow method; see map.hpp.
#include <fmt/format.h>

#include "shadows/method.hpp"
#include "shadows/shadow_map/map.hpp"

namespace shadows::shadow_map {
namespace {

using structures::Parameter;
using structures::Samples;
using structures::Settings;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;

class ShadowMapMethod final : public Method {
  public:
    ShadowMapMethod(taskpool::gpu::Device& device, const MapConfig& config)
        : map_(device, config) {}

    void prepare(const TriangleMesh& mesh) override { map_.load(mesh); }
    /// build_ms (bounds, drawing, copying to where kernels read), memory_bytes, faces.
    Samples build(const Light& light) override {
        const double milliseconds = map_.render(light);
        return {{"build_ms", milliseconds, "ms"},
                {"memory_bytes", double(map_.memory_bytes()), "bytes"},
                {"faces", double(map_.faces())}};
    }
    Samples query(const Points& points, Visibility& visible) override {
        return {{"query_ms", map_.look_up(points, visible), "ms"}};
    }

  private:
    ShadowMap map_;
};

/// `bias` of a config that leaves the choice to us.
constexpr double kUsualBias = -1;

std::span<const Parameter> parameters() {
    static const std::vector<Parameter> all = {
        {"resolution",
         std::int64_t{MapConfig{}.resolution},
         "texels along a side of each map",
         {},
         512,
         8192},
        {"bias_mode",
         std::string("receiver_plane"),
         "what keeps surfaces from shadowing themselves",
         {"constant", "slope", "receiver_plane"}},
        {"bias",
         kUsualBias,
         "how far stored depths move away from the light: in widths of a texel, or with "
         "bias_mode 'slope' in what the triangle's depth changes over a texel; -1: the usual one, "
         "3 "
         "with 'constant', 1 with 'slope', 0.25 with 'receiver_plane'",
         {},
         kUsualBias,
         1024},
    };
    return all;
}

MapConfig map_config(const Settings& settings) {
    const std::string& mode = settings.text("bias_mode");
    MapConfig config;
    config.resolution = static_cast<std::uint32_t>(settings.integer("resolution"));
    config.bias_mode = mode == "constant" ? BiasMode::constant
                       : mode == "slope"  ? BiasMode::slope
                                          : BiasMode::receiver_plane;
    const double bias = settings.real("bias");
    if (bias < 0 && bias != kUsualBias)
        throw structures::SettingError(
            "bias", fmt::format("'bias' is {}; expected 0 or more, or -1 for the usual one", bias));
    config.bias = bias < 0 ? usual_bias(config.bias_mode) : static_cast<float>(bias);
    return config;
}

std::unique_ptr<Method> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<ShadowMapMethod>(device, map_config(settings));
}

}  // namespace

std::span<const MethodRow> rows() {
    static const MethodRow all[] = {
        {"shadow_map", "depth rasterised from the light, one tap per point; approximate",
         &parameters, &create},
    };
    return all;
}

}  // namespace shadows::shadow_map
