#include "shadows/shadow_map/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

std::span<const taskpool::gpu::Shader> shadows_shadow_map_shaders();

namespace shadows::shadow_map {
namespace {

namespace gpu = taskpool::gpu;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;

constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
/// In units of the last place of a triangle's largest depth: what interpolating it may err by.
constexpr float kRounding = 16;
/// Workgroups of fit.comp: enough for any device, few enough that joining their bounds is cheap.
constexpr std::uint32_t kFitGroups = 1024;

const gpu::Shader& shader(std::string_view path) {
    return gpu::find_shader(shadows_shadow_map_shaders(), path);
}

/// By primitive id, of unit length; 0 where there is none.
std::vector<glm::vec3> normals(const TriangleMesh& mesh) {
    std::vector<glm::vec3> all(mesh.triangle_count(), glm::vec3(0));
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (mesh.degenerate(i)) continue;
        const glm::dvec3 a = mesh.corner(i, 0), b = mesh.corner(i, 1), c = mesh.corner(i, 2);
        all[i] = glm::normalize(glm::cross(b - a, c - a));
    }
    return all;
}

}  // namespace

ShadowMap::ShadowMap(gpu::Device& device, const MapConfig& config)
    : device_(device), config_(config), times_(device, 2) {}

const ShadowMap::Programs& ShadowMap::programs() {
    Programs& found = programs_[directional_];
    if (found.fit.handle()) return found;
    found.lookup = gpu::Kernel(device_, shader("shadows/shadow_map/lookup.comp"),
                               {{1, directional_},
                                {2, config_.bias_mode == BiasMode::receiver_plane},
                                {9, kTilePoints / device_.subgroup_size()}});
    gpu::RasterOptions options;
    options.depth_format = kDepthFormat;
    options.depth_bias_constant = -kRounding;
    if (config_.bias_mode == BiasMode::slope) options.depth_bias_slope = -config_.bias;
    options.constants = {{1, directional_}};
    found.depth = gpu::RasterPipeline(device_, shader("shadows/shadow_map/depth.vert"),
                                      shader("shadows/shadow_map/depth.frag"), options);
    found.fit = gpu::Kernel(device_, shader("shadows/shadow_map/fit.comp"), {{1, directional_}});
    return found;
}

void ShadowMap::load(const TriangleMesh& mesh) {
    std::vector<glm::uvec3> casters;
    bounds_ = {};
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        if (mesh.degenerate(i)) continue;
        casters.push_back(mesh.triangles[i]);
        bounds_.grow(mesh.triangle_bounds(i));
    }
    triangle_count_ = static_cast<std::uint32_t>(casters.size());
    positions_ = gpu::make_buffer<glm::vec3>(device_, mesh.positions, "shadow map positions");
    triangles_ = gpu::make_buffer<glm::uvec3>(device_, casters, "shadow map triangles");
    if (config_.bias_mode == BiasMode::receiver_plane)
        normals_ = gpu::make_buffer<glm::vec3>(device_, normals(mesh), "shadow map normals");
    fit_buffer_ = gpu::Buffer(device_, sizeof(Fit), "shadow map bounds");
    view_buffer_ = gpu::Buffer(device_, sizeof(views_), "shadow map views");
}

double ShadowMap::render(const Light& light) {
    frame_ = make_frame(light, bounds_);
    directional_ = light.type == Light::Type::directional;
    double milliseconds = triangle_count_ > 0 ? find_bounds() : 0;
    if (triangle_count_ == 0) fit_ = {};
    views_ = make_views(fit_, config_, directional_);
    view_buffer_.write(views_.data(), sizeof(views_));
    allocate_maps();
    return faces() > 0 ? milliseconds + draw_maps() : milliseconds;
}

double ShadowMap::find_bounds() {
    const std::size_t list_bytes = std::size_t{directional_ ? 1 : kFaces} * triangle_count_ * 4;
    if (casters_.size() != list_bytes)
        casters_ = gpu::Buffer(device_, list_bytes, "shadow map casters");
    const FitPush push{positions_.address(),
                       triangles_.address(),
                       casters_.address(),
                       fit_buffer_.address(),
                       frame_,
                       triangle_count_,
                       face_reach(config_)};
    const std::uint32_t lanes = device_.subgroup_size();
    times_.clear();
    gpu::Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    recorder.fill(fit_buffer_, 0, 0, offsetof(Fit, bounds));
    recorder.fill(fit_buffer_, ~0u, offsetof(Fit, bounds));
    recorder.barrier();
    recorder.dispatch(programs().fit, push,
                      std::min((triangle_count_ + lanes - 1) / lanes, kFitGroups));
    recorder.barrier();
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    fit_ = gpu::read<Fit>(fit_buffer_, 1).front();
    return times_.milliseconds("begin", "end");
}

void ShadowMap::allocate_maps() {
    const std::size_t bytes = faces() * map_bytes();
    if (maps_.size() == bytes) return;
    maps_ = {};
    if (bytes == 0) return;
    try {
        const std::uint64_t missing = bytes + (target_.handle() ? 0 : map_bytes());
        const gpu::DeviceInfo& limits = device_.info();
        if (device_.allocated_bytes() + missing > limits.memory_bytes)
            throw gpu::Error(
                VK_ERROR_OUT_OF_DEVICE_MEMORY,
                fmt::format("{} maps need {} MiB on '{}' ({} of {} MiB in use)", faces(),
                            missing >> 20, limits.name, device_.allocated_bytes() >> 20,
                            limits.memory_bytes >> 20));
        if (!target_.handle())
            target_ = gpu::Image(device_, kDepthFormat, config_.resolution, config_.resolution,
                                 "shadow map");
        maps_ = gpu::Buffer(device_, bytes, "shadow maps");
    } catch (const gpu::Error& error) {
        throw gpu::Error(error.result,
                         fmt::format("shadow map of {} x {}: {}; lower 'resolution'",
                                     config_.resolution, config_.resolution, error.what()));
    }
}

double ShadowMap::draw_maps() {
    DepthPush push{positions_.address(), triangles_.address(), 0, frame_, {}, 0};
    gpu::RenderTargets targets;
    targets.depth = &target_;
    times_.clear();
    gpu::Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    for (std::uint32_t face = 0; face < kFaces; ++face) {
        if (fit_.casters[face] == 0) continue;
        push.casters = casters_.address() + std::uint64_t{face} * triangle_count_ * 4;
        push.view = views_[face];
        push.face = face;
        recorder.begin_rendering("shadow map", targets);
        recorder.draw(programs().depth, push, 3 * fit_.casters[face]);
        recorder.end_rendering();
        recorder.copy(target_, VK_IMAGE_ASPECT_DEPTH_BIT, maps_, views_[face].slot * map_bytes());
    }
    recorder.barrier();
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    return times_.milliseconds("begin", "end");
}

double ShadowMap::look_up(const Points& points, Visibility& visible) {
    if (!visible_.handle() || visible_.size() != points.count() / 8)
        visible_ = gpu::Buffer(device_, points.count() / 8, "visibility");
    const LookupPush push{points.address(),   visible_.address(), view_buffer_.address(),
                          maps_.address(),    normals_.address(), frame_,
                          config_.resolution, points.count()};
    constexpr std::uint32_t kRow = 1u << 12;
    const std::uint32_t tiles = points.count() / kTilePoints;
    times_.clear();
    gpu::Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    recorder.dispatch(programs().lookup, push, std::min(tiles, kRow), (tiles + kRow - 1) / kRow);
    recorder.barrier();
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    visible.words = gpu::read<std::uint32_t>(visible_, points.count() / 32);
    return times_.milliseconds("begin", "end");
}

std::uint32_t ShadowMap::faces() const {
    return static_cast<std::uint32_t>(std::count_if(std::begin(fit_.casters),
                                                    std::end(fit_.casters),
                                                    [](std::uint32_t count) { return count > 0; }));
}

std::size_t ShadowMap::memory_bytes() const {
    return positions_.size() + triangles_.size() + normals_.size() + casters_.size() +
           fit_buffer_.size() + view_buffer_.size() + maps_.size() +
           (target_.handle() ? map_bytes() : 0);
}

}  // namespace shadows::shadow_map
