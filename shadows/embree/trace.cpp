#include "shadows/embree/trace.hpp"

#include <algorithm>
#include <limits>

namespace shadows::embree {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

RTCIntersectContext coherent_context() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay8* rays) {
    rtcOccluded8(valid, scene, context, rays);
}
void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRay16* rays) {
    rtcOccluded16(valid, scene, context, rays);
}
template <int width>
void occluded(const int*, RTCScene scene, RTCIntersectContext* context, RTCRayNt<width>* rays) {
    const RTCRayNp pointers = {rays->org_x, rays->org_y, rays->org_z, rays->tnear,
                               rays->dir_x, rays->dir_y, rays->dir_z, rays->time,
                               rays->tfar,  rays->mask,  rays->id,    rays->flags};
    rtcOccludedNp(scene, context, &pointers, width);
}

template <typename Packet, int width>
void trace_packets(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                   std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words) {
    RTCIntersectContext context = coherent_context();
    alignas(64) Packet packet;
    alignas(64) int valid[width];
    // The half of each ray that all have in common; the loop writes the other half.
    float* const common[3] = {rays.from_light ? packet.org_x : packet.dir_x,
                              rays.from_light ? packet.org_y : packet.dir_y,
                              rays.from_light ? packet.org_z : packet.dir_z};
    float* const own[3] = {rays.from_light ? packet.dir_x : packet.org_x,
                           rays.from_light ? packet.dir_y : packet.org_y,
                           rays.from_light ? packet.dir_z : packet.org_z};
    const float* const positions[3] = {points.x.data(), points.y.data(), points.z.data()};
    const glm::vec3 shift = rays.from_light ? rays.vector : glm::vec3(0);
    for (int axis = 0; axis < 3; ++axis) std::fill_n(common[axis], width, rays.vector[axis]);
    std::fill_n(packet.tnear, width, rays.near);
    std::fill_n(packet.time, width, 0.0f);
    std::fill_n(packet.mask, width, 0xffffffffu);
    std::fill_n(packet.id, width, 0u);
    std::fill_n(packet.flags, width, 0u);

    std::fill_n(words.begin() + first / 32, count / 32, ~0u);
    for (std::uint32_t base = first; base < first + count; base += width) {
        int any_valid = 0;
        for (int i = 0; i < width; ++i) {
            valid[i] = points.primitive[base + i] == kNoPrimitive ? 0 : -1;
            any_valid |= valid[i];
            // Streams take no mask: an inactive ray ends before it begins.
            packet.tfar[i] = valid[i] ? rays.far : -1;
        }
        if (!any_valid) continue;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < width; ++i) own[axis][i] = positions[axis][base + i] - shift[axis];
        occluded(valid, scene, &context, &packet);
        // Embree marks an occluded ray by tfar = -inf, and where the CPU has no such packets
        // natively it does so to inactive rays too.
        for (int start = 0; start < width; start += 32) {
            std::uint32_t shadowed = 0;
            for (int i = start; i < std::min(start + 32, width); ++i)
                shadowed |= static_cast<std::uint32_t>(valid[i] & (packet.tfar[i] < 0))
                            << (i - start);
            words[(base + start) / 32] &= ~(shadowed << (base + start) % 32);
        }
    }
}

}  // namespace

ShadowRays::ShadowRays(const structures::geometry::Light& light, float scene_diagonal, float bias)
    : from_light(light.type == structures::geometry::Light::Type::point),
      vector(light.vector),
      near(from_light ? 0 : bias),
      far(from_light ? 1 - bias : kInfinity) {
    // In double precision, where no float's square under- or overflows.
    if (!from_light)
        vector = -glm::normalize(glm::dvec3(vector)) * std::max(double{scene_diagonal}, 1e-30);
}

void trace_single(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                  std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words) {
    RTCIntersectContext context = coherent_context();
    RTCRay ray;
    ray.tnear = rays.near;
    ray.time = 0;
    ray.mask = 0xffffffffu;
    ray.id = ray.flags = 0;
    for (std::uint32_t word = first / 32; word < (first + count) / 32; ++word) {
        std::uint32_t shadowed = 0;
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            const std::uint32_t i = word * 32 + bit;
            if (points.primitive[i] == kNoPrimitive) continue;
            const glm::vec3 p(points.x[i], points.y[i], points.z[i]);
            const glm::vec3 origin = rays.from_light ? rays.vector : p;
            const glm::vec3 direction = rays.from_light ? p - rays.vector : rays.vector;
            ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
            ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
            ray.tfar = rays.far;
            rtcOccluded1(scene, &context, &ray);
            shadowed |= std::uint32_t{ray.tfar < 0} << bit;
        }
        words[word] = ~shadowed;
    }
}

void trace_packets_8(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                     std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words) {
    trace_packets<RTCRay8, 8>(scene, rays, points, first, count, words);
}
void trace_packets_16(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                      std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words) {
    trace_packets<RTCRay16, 16>(scene, rays, points, first, count, words);
}
void trace_streams(RTCScene scene, const ShadowRays& rays, const PointArrays& points,
                   std::uint32_t first, std::uint32_t count, std::span<std::uint32_t> words) {
    trace_packets<RTCRayNt<64>, 64>(scene, rays, points, first, count, words);
}

}  // namespace shadows::embree
