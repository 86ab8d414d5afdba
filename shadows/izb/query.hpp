// Shadow query by an irregular z-buffer: for each G-buffer point, is the segment to the light free?
//
//     Query query(device, {});
//     query.prepare(mesh);
//     query.set_light(light);
//     QueryResult result = query.run(points, visible);
//
// The points are sorted into the cells of a grid on the faces of a cube around the light (one plane
// for a directional light), fitted to what they fill of it, with a pyramid of the farthest point
// above the cells. Each triangle is rasterised conservatively: cells whose points it may shadow,
// and which are not all in front of its plane or shadowed already, have their points tested, first
// by linear functions with error bounds (caster.glsl), and where those cannot decide by the exact
// test (shadows/occlusion.glsl), whose last resort has a pass of its own. After G. Johnson, J. Lee,
// C. Burns and W. Mark, "The irregular z-buffer: hardware acceleration for irregular data
// structures", 2005, and T. Aila and S. Laine, "Alias-free shadow maps", 2004; the compute version
// after C. Wyman, R. Hoetzlein and A. Lefohn, "Frustum-traced raster shadows", 2015. Deviations:
// points are compacted per cell instead of linked in lists, and triangles that cross planes through
// the light are not clipped.
//
// Lists that turn out too short are used with fewer triangles at a time; nothing is dropped.
#pragma once

#include <array>
#include <cstdint>

#include "shadows/izb/grid.hpp"
#include "shadows/points.hpp"
#include "structures/geometry/triangle_mesh.hpp"
#include "taskpool/gpu/recorder.hpp"
#include "taskpool/primitives/scan.hpp"

namespace shadows::izb {

struct QueryConfig {
    std::uint32_t resolution = 0;  ///< cells along a face's longer side; 0: from the points
    bool statistics = false;
    std::uint32_t entries = 0;  ///< room in the list of entries; 0: from the number of triangles
    bool operator==(const QueryConfig&) const = default;
};

struct QueryResult {
    double milliseconds = 0;        ///< on the host's clock, all submissions and waits for them
    std::uint32_t incomplete = 0;   ///< points answered lit unasked: their place overflows
    std::uint32_t cells = 0;        ///< of all faces
    std::uint64_t entries = 0;      ///< pairs of a triangle and a block of cells
    std::uint64_t ranges = 0;       ///< pieces of crowded cells, tested apart
    std::uint32_t passes = 0;       ///< over the triangles: more than 1 where a list was too short
    std::uint64_t tests = 0;        ///< with statistics: point-triangle pairs tested
    std::uint64_t exact_tests = 0;  ///< with statistics: of these, by the exact test
    std::uint64_t unsure = 0;       ///< pairs decided by its last resort, occludes_exactly
};

class Query {
  public:
    Query(taskpool::gpu::Device& device, const QueryConfig& config);

    /// Uploads the triangles that can cast a shadow: finite, and not degenerate. Throws
    /// std::invalid_argument if there are 2^29 or more.
    void prepare(const structures::geometry::TriangleMesh& mesh);
    /// Throws std::invalid_argument if the light is not finite, or a directional one is 0.
    void set_light(const structures::geometry::Light& light);
    /// Submits, twice or more, and waits: the first time for the points' extent, from which the
    /// host makes the grid. Later queries find buffers and kernels ready, and the number of
    /// triangles for which lists have room.
    QueryResult run(const Points& points, Visibility& visible);

    std::size_t memory_bytes() const;

  private:
    struct Kernels {
        taskpool::gpu::Kernel bounds, count, scatter, reduce, cast, test, ranges, unsure, plan,
            answer;
    };
    struct Push;
    struct Lists {
        std::uint32_t entries, ranges, unsure;  // for how many there is room
    };

    const Kernels& kernels();
    std::uint32_t chunk_entries() const;  ///< that a workgroup tests in one go
    Push make_push(const Points& points) const;
    void allocate_points(std::uint32_t count);
    Lists allocate_cells(const Grid& grid, std::uint32_t points);
    IzbExtents find_extents(const Points& points);
    void record_binning(taskpool::gpu::Recorder& recorder, const Push& push, const Grid& grid);
    /// Triangles from `first` to before `end`: all lists, unless one overflows.
    void record_batch(taskpool::gpu::Recorder& recorder, const Push& push, const Lists& room,
                      std::uint32_t first, std::uint32_t end);
    /// Bins the points, casts the triangles, in batches that fit, and writes the answer.
    void shadow(const Points& points, const Grid& grid, QueryResult& result);

    taskpool::gpu::Device& device_;
    QueryConfig config_;
    taskpool::primitives::Scan scan_;
    std::array<Kernels, 2> kernels_;  ///< point, directional; compiled when first needed
    taskpool::gpu::Buffer triangles_, frame_, extents_, status_;
    taskpool::gpu::Buffer keys_, places_, order_, binned_, visible_;  // per point
    taskpool::gpu::Buffer cells_, farthest_, scratch_;                // per cell
    taskpool::gpu::Buffer entries_, ranges_;
    structures::geometry::Aabb bounds_;
    structures::geometry::Light light_;
    IzbFrame base_frame_{};
    std::uint32_t triangle_count_ = 0;
    std::uint32_t batch_ = 0;  ///< triangles in one go
};

}  // namespace shadows::izb
