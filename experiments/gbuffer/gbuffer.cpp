#include "experiments/gbuffer/gbuffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/gbuffer/gbuffer_shared.h"
#include "taskpool/gpu/recorder.hpp"

std::span<const taskpool::gpu::Shader> experiments_gbuffer_shaders();

namespace experiments::gbuffer {
namespace {

namespace gpu = taskpool::gpu;
using shadows::kTilePoints;
using shadows::kTileSide;
using structures::geometry::TriangleMesh;

constexpr std::uint32_t kMaxSide = 4096;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr std::uint32_t kPlanes = 7;  ///< x, y, z, primitive, normal x, y, z

const gpu::Shader& shader(std::string_view path) {
    return gpu::find_shader(experiments_gbuffer_shaders(), path);
}

/// As near as single precision clips well: this part of the distance of the farthest corner of the
/// mesh's box. Depth does not lose by it, being evaluated per pixel.
float near_distance(const TriangleMesh& mesh, const scenes::Camera& camera) {
    constexpr float kNearPart = 1.f / 65536, kMinNear = 1e-30f;
    const structures::geometry::Aabb box = mesh.bounds();
    if (box.empty()) return 1;
    const glm::vec3 farthest =
        glm::max(glm::abs(box.lower - camera.eye), glm::abs(box.upper - camera.eye));
    return std::max(glm::length(farthest) * kNearPart, kMinNear);
}

struct Pushes {
    VisibilityPush visibility;
    ResolvePush resolve;
};

/// Camera and image size as the shaders want them; addresses are left to the caller. Both shaders
/// work with the same rounded rows, so resolve's rays are those of the rasteriser.
Pushes make_pushes(const TriangleMesh& mesh, const scenes::Camera& camera, std::uint32_t width,
                   std::uint32_t height) {
    const float near = near_distance(mesh, camera);
    const glm::mat4 rows =
        glm::transpose(camera.view_projection(float(width) / float(height), near));
    Pushes pushes{};
    VisibilityPush& visibility = pushes.visibility;
    visibility.eye = camera.eye;
    visibility.row_x = rows[0];
    visibility.row_y = rows[1];
    visibility.row_w = rows[3];
    visibility.near = near;
    visibility.ndc_per_pixel = {2.f / float(width), 2.f / float(height)};

    // A direction d with (row_x, row_y, row_w) d = (x, y, 1) points through (x, y) of the screen.
    const glm::dmat3 screen_to_world = glm::inverse(
        glm::transpose(glm::dmat3(visibility.row_x, visibility.row_y, visibility.row_w)));
    ResolvePush& resolve = pushes.resolve;
    resolve.origin = screen_to_world * glm::dvec3(-1, -1, 1);
    resolve.right = screen_to_world[0] * (2.0 / width);
    resolve.down = screen_to_world[1] * (2.0 / height);
    resolve.eye = camera.eye;
    resolve.width = width;
    resolve.height = height;
    return pushes;
}

shadows::PointArrays download(const gpu::Buffer& planes, std::size_t count) {
    shadows::PointArrays arrays;
    arrays.x = gpu::read<float>(planes, count, 0);
    arrays.y = gpu::read<float>(planes, count, count);
    arrays.z = gpu::read<float>(planes, count, 2 * count);
    arrays.primitive = gpu::read<std::uint32_t>(planes, count, 3 * count);
    arrays.normal.resize(count);
    for (int axis = 0; axis < 3; ++axis) {
        const auto plane = gpu::read<float>(planes, count, (4 + axis) * count);
        for (std::size_t i = 0; i < count; ++i) arrays.normal[i][axis] = plane[i];
    }
    return arrays;
}

void check_arguments(const scenes::Camera& camera, std::uint32_t width, std::uint32_t height) {
    if (width < 1 || width > kMaxSide || height < 1 || height > kMaxSide)
        throw std::invalid_argument(fmt::format(
            "G-buffer of {} x {} pixels: each side must be 1 to {}", width, height, kMaxSide));
    if (const std::string fault = camera.fault(); !fault.empty())
        throw std::invalid_argument("camera: " + fault);
}

}  // namespace

GBuffer render_gbuffer(gpu::Device& device, const TriangleMesh& mesh, const scenes::Camera& camera,
                       std::uint32_t width, std::uint32_t height) {
    check_arguments(camera, width, height);
    const auto tiles = [](std::uint32_t side) { return (side + kTileSide - 1) / kTileSide; };
    const std::size_t count = std::size_t{tiles(width)} * tiles(height) * kTilePoints;

    gpu::RasterOptions options;
    options.color_formats = {VK_FORMAT_R32_UINT};
    options.depth_format = kDepthFormat;
    const gpu::RasterPipeline visibility(device, shader("experiments/gbuffer/visibility.vert"),
                                         shader("experiments/gbuffer/visibility.frag"), options);
    const gpu::Kernel resolve(device, shader("experiments/gbuffer/resolve.comp"));

    const gpu::Buffer positions =
        gpu::make_buffer<glm::vec3>(device, mesh.positions, "G-buffer positions");
    const gpu::Buffer triangles =
        gpu::make_buffer<glm::uvec3>(device, mesh.triangles, "G-buffer triangles");
    const gpu::Image ids(device, VK_FORMAT_R32_UINT, width, height, "primitive ids");
    const gpu::Image depth(device, kDepthFormat, width, height, "depth");
    const gpu::Buffer id_rows(device, std::size_t{width} * height * 4, "primitive id rows");
    const gpu::Buffer planes(device, count * kPlanes * 4, "G-buffer");

    Pushes pushes = make_pushes(mesh, camera, width, height);
    pushes.visibility.positions = pushes.resolve.positions = positions.address();
    pushes.visibility.triangles = pushes.resolve.triangles = triangles.address();
    pushes.resolve.ids = id_rows.address();
    pushes.resolve.points = planes.address();

    gpu::RenderTargets targets;
    targets.colors.push_back({&ids, {.uint32 = {shadows::kNoPrimitive}}});
    targets.depth = &depth;
    gpu::Timestamps times(device, 2);
    for (int run = 0; run < 2; ++run) {  // the first one compiles
        times.clear();
        gpu::Recorder recorder(device);
        recorder.timestamp(times, "begin");
        recorder.begin_rendering("visibility buffer", targets);
        recorder.draw(visibility, pushes.visibility, 3 * std::uint32_t(mesh.triangle_count()));
        recorder.end_rendering();
        recorder.copy(ids, VK_IMAGE_ASPECT_COLOR_BIT, id_rows);
        recorder.barrier();
        recorder.dispatch(resolve, pushes.resolve, tiles(width), tiles(height));
        recorder.barrier();
        recorder.timestamp(times, "end");
        device.run(recorder);
    }
    return {shadows::Points(device, download(planes, count), width, height),
            times.milliseconds("begin", "end")};
}

}  // namespace experiments::gbuffer
