// A shadow query that answers tile by tile: for each G-buffer point, is the segment to the light
// free? Whatever structure is walked, this is the host's side of it.
//
//     TileQuery query(device, limits, {query_shader, deferred_shader, constants});
//     query.prepare(points.count());
//     query.record(recorder, structure, points.address(), points.count(), light);
//     device.run(recorder);
//     Visibility visible = query.visibility();
//     assert(query.status().incomplete == 0);
//
// The kernels include shadows/tiles/{tiles,lanes,packets,beams}.glsl. What the first cannot finish
// within its limits, or without the last resort of the exact test (occludes_exactly), is left to a
// per-point walk, recorded behind it as an indirect dispatch; nothing is dropped, and the status
// counts what happened.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "shadows/points.hpp"
#include "shadows/tiles/query_shared.h"
#include "structures/geometry/light.hpp"
#include "structures/sample.hpp"
#include "taskpool/gpu/recorder.hpp"

namespace shadows::tiles {

struct Limits {
    std::uint32_t stack = 32;         ///< entries of the traversal stack
    std::uint32_t scratch = 1024;     ///< words of a workgroup, if beams use any
    std::uint32_t steps = 1'000'000;  ///< loop iterations of one traversal
    std::uint32_t density = 3;        ///< triangles per point that a beam may meet
    // Of the per-point walk.
    std::uint32_t point_stack = 32;
    std::uint32_t point_steps = 10'000'000;
    bool statistics = false;

    bool operator==(const Limits&) const = default;
};

struct Shaders {
    const taskpool::gpu::Shader* query = nullptr;
    const taskpool::gpu::Shader* deferred = nullptr;
    bool per_point = false;  ///< `query` walks with the limits of single points
    std::vector<taskpool::gpu::Constant> constants;  ///< the structure's own, ids from 20 on
};

class TileQuery {
  public:
    TileQuery(taskpool::gpu::Device& device, const Limits& limits, Shaders shaders);

    /// Allocates for up to `point_count` points.
    void prepare(std::uint32_t point_count);
    std::size_t memory_bytes() const;

    /// Records one query of `structure`, the kernel's struct Structure: `points` is the address of
    /// four planes of `point_count` words (Points). Submits nothing. Throws std::invalid_argument
    /// if more points were not prepared for.
    template <typename Structure>
    void record(taskpool::gpu::Recorder& recorder, const Structure& structure, std::uint64_t points,
                std::uint32_t point_count, const structures::geometry::Light& light) {
        static_assert(std::is_trivially_copyable_v<Structure> && sizeof(Structure) % 8 == 0);
        const QueryPush<Structure> push{push_for(points, point_count, light), structure};
        record_clearing(recorder);
        const Kernels& pair = kernels(light.type == structures::geometry::Light::Type::directional);
        recorder.dispatch(pair.query, push, groups(point_count));
        recorder.barrier();
        recorder.dispatch_indirect(pair.deferred, push, status_, kDeferredOffset);
        recorder.barrier();
    }

    /// Of the last finished query.
    Visibility visibility() const;
    QueryStatus status() const;
    /// With statistics: per point, nodes visited and triangles tested by the traversals it took
    /// part in.
    std::vector<PointCost> costs() const;
    /// What the last query counted, for `valid_count` points with geometry; with statistics, means.
    structures::Samples counters(std::uint32_t valid_count) const;
    /// Per point, nodes visited; empty without statistics.
    std::vector<float> heat() const;

  private:
    struct CommonPush {
        std::uint64_t points, visible, deferred, tiles, costs, status, scratch;
        glm::vec3 light;
        std::uint32_t point_count;
    };
    template <typename Structure>
    struct QueryPush {
        CommonPush common;
        Structure structure;
    };
    struct Kernels {
        taskpool::gpu::Kernel query, deferred;
    };

    CommonPush push_for(std::uint64_t points, std::uint32_t point_count,
                        const structures::geometry::Light& light) const;
    void record_clearing(taskpool::gpu::Recorder& recorder) const;
    std::uint32_t groups(std::uint32_t point_count) const;
    const Kernels& kernels(bool directional);
    taskpool::gpu::Kernel kernel(bool directional, bool deferred) const;

    taskpool::gpu::Device& device_;
    Limits limits_;
    Shaders shaders_;
    std::array<Kernels, 2> kernels_;  ///< point, directional; compiled when first needed
    taskpool::gpu::Buffer visible_, deferred_, tiles_, costs_, status_, scratch_;
    std::uint32_t point_count_ = 0;
};

}  // namespace shadows::tiles
