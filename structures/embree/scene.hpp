// A mesh in Embree: owns the device, the input buffers and the built scene.
//
//     Scene scene(threads);
//     scene.load(mesh);                              // copies the input
//     double ms = scene.build(Quality::medium);
//     rtcOccluded1(scene.handle(), ...);
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>
#include <type_traits>

#include "structures/geometry/triangle_mesh.hpp"

namespace structures::embree {

enum class Quality { low, medium, high };
/// From "low", "medium" or "high".
Quality quality_from(std::string_view name);

class Scene {
  public:
    /// 0 threads: all cores build. Throws std::runtime_error if Embree has no device.
    explicit Scene(unsigned threads);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Copies the non-degenerate triangles. Throws std::runtime_error when memory does not suffice.
    void load(const structures::geometry::TriangleMesh& mesh);
    /// Builds the loaded mesh from scratch, `robust`: with RTC_SCENE_FLAG_ROBUST, and returns the
    /// wall time of committing geometry and scene, in milliseconds.
    double build(Quality quality, bool robust = true);
    /// The built scene; null before build().
    RTCScene handle() const { return scene_.get(); }
    /// What Embree holds now, input buffers included.
    std::int64_t memory_bytes() const { return memory_bytes_; }

  private:
    void check(const char* what) const;

    /// Embree's objects are reference-counted handles.
    template <auto release>
    struct Release {
        template <typename Handle>
        void operator()(Handle handle) const {
            release(handle);
        }
    };
    template <typename Handle, auto release>
    using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release<release>>;

    std::atomic<std::int64_t> memory_bytes_{0};  ///< outlives the device that reports to it
    Owned<RTCDevice, rtcReleaseDevice> device_;
    Owned<RTCBuffer, rtcReleaseBuffer> positions_, triangles_;
    std::size_t position_count_ = 0, triangle_count_ = 0;
    Owned<RTCScene, rtcReleaseScene> scene_;
};

}  // namespace structures::embree
