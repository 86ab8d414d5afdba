#include "structures/embree/scene.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <stdexcept>

namespace structures::embree {
namespace {

RTCBuildQuality rtc_quality(Quality quality) {
    switch (quality) {
        case Quality::low:
            return RTC_BUILD_QUALITY_LOW;
        case Quality::medium:
            return RTC_BUILD_QUALITY_MEDIUM;
        case Quality::high:
            return RTC_BUILD_QUALITY_HIGH;
    }
    throw std::logic_error("embree: unknown quality");
}

const char* name_of(RTCError error) {
    switch (error) {
        case RTC_ERROR_INVALID_ARGUMENT:
            return "invalid argument";
        case RTC_ERROR_INVALID_OPERATION:
            return "invalid operation";
        case RTC_ERROR_OUT_OF_MEMORY:
            return "out of memory";
        case RTC_ERROR_UNSUPPORTED_CPU:
            return "this CPU lacks SSE2";
        case RTC_ERROR_CANCELLED:
            return "cancelled";
        default:
            return "unknown error";
    }
}

bool count_memory(void* total, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
    return true;
}

}  // namespace

Quality quality_from(std::string_view name) {
    if (name == "low") return Quality::low;
    return name == "high" ? Quality::high : Quality::medium;
}

Scene::Scene(unsigned threads) {
    // Builder threads start now, not within the first build.
    device_.reset(rtcNewDevice(fmt::format("threads={},start_threads=1", threads).c_str()));
    check("creating a device");
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_memory, &memory_bytes_);
}

void Scene::check(const char* what) const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE)
        throw std::runtime_error(fmt::format("embree: {} failed: {}", what, name_of(error)));
}

void Scene::load(const structures::geometry::TriangleMesh& mesh) {
    scene_.reset();
    positions_.reset();
    triangles_.reset();
    position_count_ = mesh.positions.size();
    triangle_count_ = 0;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) triangle_count_ += !mesh.degenerate(i);
    if (triangle_count_ == 0) return;

    // Embree reads 16 bytes at every position: its own buffers are padded for that.
    const std::size_t position_bytes = position_count_ * sizeof(glm::vec3);
    positions_.reset(rtcNewBuffer(device_.get(), position_bytes));
    triangles_.reset(rtcNewBuffer(device_.get(), triangle_count_ * sizeof(glm::uvec3)));
    check("allocating the mesh");
    std::memcpy(rtcGetBufferData(positions_.get()), mesh.positions.data(), position_bytes);
    auto* target = static_cast<glm::uvec3*>(rtcGetBufferData(triangles_.get()));
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
        if (!mesh.degenerate(i)) *target++ = mesh.triangles[i];
}

double Scene::build(Quality quality, bool robust) {
    scene_.reset();
    Owned<RTCScene, rtcReleaseScene> scene(rtcNewScene(device_.get()));
    if (robust) rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), rtc_quality(quality));
    Owned<RTCGeometry, rtcReleaseGeometry> geometry;
    if (triangle_count_ > 0) {
        geometry.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        rtcSetGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             positions_.get(), 0, sizeof(glm::vec3), position_count_);
        rtcSetGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             triangles_.get(), 0, sizeof(glm::uvec3), triangle_count_);
        rtcAttachGeometry(scene.get(), geometry.get());
    }
    const auto begin = std::chrono::steady_clock::now();
    if (geometry) rtcCommitGeometry(geometry.get());
    rtcCommitScene(scene.get());
    const auto end = std::chrono::steady_clock::now();
    check("building the scene");
    scene_ = std::move(scene);
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

}  // namespace structures::embree
