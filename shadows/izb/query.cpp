#include "shadows/izb/query.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "structures/geometry/corner_triangle.h"

std::span<const taskpool::gpu::Shader> shadows_izb_shaders();

namespace shadows::izb {

using structures::geometry::CornerTriangle;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using taskpool::gpu::Buffer;
using taskpool::gpu::Kernel;
using taskpool::gpu::Recorder;

struct Query::Push {
    std::uint64_t frame, points, cells, farthest, keys, places, order, binned, triangles, entries,
        ranges, status;
    glm::vec3 light;
    std::uint32_t point_count;
    glm::uvec4 job;

    Push with(std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0,
              std::uint32_t w = 0) const {
        Push copy = *this;
        copy.job = {x, y, z, w};
        return copy;
    }
    Push with_address(std::uint32_t x, std::uint64_t address) const {
        Push copy = *this;
        copy.job = {x, 0, std::uint32_t(address), std::uint32_t(address >> 32)};
        return copy;
    }
};

namespace {

constexpr std::uint32_t kMaxGroups = 32768;  // of one dimension of a dispatch
constexpr std::uint32_t kRunPoints = 4096;   // of one workgroup that goes through the points
constexpr std::uint32_t kWordBytes = 4;

std::uint32_t divide_up(std::uint32_t count, std::uint32_t by) { return (count + by - 1) / by; }

/// Dispatches at least `groups` workgroups; kernels tell surplus ones by their index.
template <typename Push>
void dispatch(Recorder& recorder, const Kernel& kernel, const Push& push, std::uint32_t groups) {
    const std::uint32_t rows = divide_up(groups, kMaxGroups);
    recorder.dispatch(kernel, push, divide_up(groups, rows), rows);
}

/// Makes `buffer` at least so large; what it held may be lost.
void grow(taskpool::gpu::Device& device, Buffer& buffer, std::size_t bytes, const char* name) {
    if (buffer.size() >= bytes && buffer.address() != 0) return;
    buffer = Buffer();
    buffer = Buffer(device, bytes, name);
}

}  // namespace

Query::Query(taskpool::gpu::Device& device, const QueryConfig& config)
    : device_(device),
      config_(config),
      scan_(device),
      frame_(device, sizeof(IzbFrame), "izb frame"),
      extents_(device, sizeof(IzbExtents), "izb extents"),
      status_(device, sizeof(IzbStatus), "izb status") {}

void Query::prepare(const TriangleMesh& mesh) {
    std::vector<CornerTriangle> triangles;
    bounds_ = {};
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const glm::vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        if (mesh.degenerate(t)) continue;
        triangles.push_back({a, b, c, t});
        for (const glm::vec3& corner : {a, b, c}) bounds_.grow(corner);
    }
    if (triangles.size() > kCasterMask)
        throw std::invalid_argument("izb: 2^29 triangles or more; use fewer");
    triangle_count_ = static_cast<std::uint32_t>(triangles.size());
    triangles_ = taskpool::gpu::make_buffer<CornerTriangle>(device_, triangles, "izb triangles");
    batch_ = triangle_count_;
}

void Query::set_light(const Light& light) {
    structures::geometry::require_usable(light);
    light_ = light;
    batch_ = triangle_count_;
    if (triangle_count_ == 0) return;
    base_frame_ = make_frame(bounds_, light);
    frame_.write(&base_frame_, sizeof(IzbFrame));
}

std::size_t Query::memory_bytes() const {
    std::size_t bytes = 0;
    for (const Buffer* buffer :
         {&triangles_, &frame_, &extents_, &status_, &keys_, &places_, &order_, &binned_, &visible_,
          &cells_, &farthest_, &scratch_, &entries_, &ranges_})
        bytes += buffer->size();
    return bytes;
}

std::uint32_t Query::chunk_entries() const {
    // Where loops are cut, at 65,535 iterations in all, an invocation gets one chunk and tests a
    // quarter of that in batches of points. On top of these, an entry of 256 x 8 cells takes 2
    // iterations per cell and at most 600 for blocks of cells, below 5,000; and one for each
    // kRangePoints points per lane, of which there are few: 4 entries leave room for 50 million.
    return device_.info().loop_limit > 0 ? 4 : device_.subgroup_size();
}

const Query::Kernels& Query::kernels() {
    const bool directional = light_.type == Light::Type::directional;
    Kernels& found = kernels_[directional];
    if (found.bounds.handle()) return found;
    const std::uint32_t limit = device_.info().loop_limit;
    const bool cut = limit > 0;
    const auto kernel = [&](const char* path) {
        return Kernel(device_, taskpool::gpu::find_shader(shadows_izb_shaders(), path),
                      {{1, directional},
                       {2, config_.statistics},
                       {3, cut ? 1u : 0xffffffffu},
                       {4, cut ? limit / 4 : 0xffffffffu},
                       {5, chunk_entries()},
                       {9, kTilePoints / device_.subgroup_size()}});
    };
    found = {kernel("shadows/izb/bounds.comp"),  kernel("shadows/izb/count.comp"),
             kernel("shadows/izb/scatter.comp"), kernel("shadows/izb/reduce.comp"),
             kernel("shadows/izb/cast.comp"),    kernel("shadows/izb/test.comp"),
             kernel("shadows/izb/ranges.comp"),  kernel("shadows/izb/unsure.comp"),
             kernel("shadows/izb/plan.comp"),    kernel("shadows/izb/answer.comp")};
    return found;
}

Query::Push Query::make_push(const Points& points) const {
    return {frame_.address(),
            points.address(),
            cells_.address(),
            farthest_.address(),
            keys_.address(),
            places_.address(),
            order_.address(),
            binned_.address(),
            triangles_.address(),
            entries_.address(),
            ranges_.address(),
            status_.address(),
            light_.type == Light::Type::directional ? -light_.vector : light_.vector,
            points.count(),
            {}};
}

void Query::allocate_points(std::uint32_t count) {
    const std::size_t words = std::size_t{count} * kWordBytes;
    grow(device_, places_, words, "izb places");
    grow(device_, order_, words, "izb order");
    // Becomes the list of unsure pairs. One triangle alone always finds room: no two of its entries
    // share a cell, so that it meets no point twice.
    grow(device_, keys_, 2 * words, "izb keys");
    grow(device_, binned_, count * sizeof(IzbPoint), "izb binned points");
    grow(device_, visible_, count / 8, "visibility");
}

Query::Lists Query::allocate_cells(const Grid& grid, std::uint32_t points) {
    const std::size_t cells = grid.cell_count;
    grow(device_, cells_, (cells + 1) * kWordBytes, "izb cells");
    grow(device_, farthest_, grid.node_count * std::size_t{kWordBytes}, "izb pyramid");
    grow(device_, scratch_, scan_.scratch_bytes(grid.cell_count + 1), "izb scratch");
    // One triangle alone always finds room: an entry for each row of tiles and kRowCells cells of
    // it, and a range for each cell and another for each kRangePoints points.
    const std::size_t blocks =
        kFaces * std::size_t{kMaxResolution >> kTileLog} * ((kMaxResolution / kRowCells) + 1);
    const std::size_t entries =
        std::max(config_.entries > 0 ? config_.entries : 4 * std::size_t{triangle_count_}, blocks);
    const std::size_t ranges = cells + points / kRangePoints + 1;
    grow(device_, entries_, entries * sizeof(IzbEntry), "izb entries");
    grow(device_, ranges_, ranges * sizeof(IzbRange), "izb ranges");
    return {std::uint32_t(entries), std::uint32_t(ranges), points};
}

IzbExtents Query::find_extents(const Points& points) {
    Recorder recorder(device_);
    recorder.fill(extents_, 0);
    recorder.barrier();
    dispatch(recorder, kernels().bounds,
             make_push(points).with_address(kRunPoints, extents_.address()),
             divide_up(points.count(), kRunPoints));
    recorder.barrier();
    device_.run(recorder);
    return taskpool::gpu::read<IzbExtents>(extents_, 1).front();
}

void Query::record_binning(Recorder& recorder, const Push& push, const Grid& grid) {
    const Kernels& kernel = kernels();
    const std::uint32_t runs = divide_up(push.point_count, kRunPoints);
    const std::uint32_t cells = grid.cell_count + 1;
    recorder.fill(cells_, 0, 0, std::size_t{cells} * kWordBytes);
    recorder.fill(farthest_, 0xffffffffu, 0, std::size_t{grid.node_count} * kWordBytes);
    recorder.barrier();
    dispatch(recorder, kernel.count, push.with(kRunPoints), runs);
    recorder.barrier();
    scan_.record(recorder, cells_, cells_, cells, scratch_);
    dispatch(recorder, kernel.scatter, push.with(kRunPoints), runs);
    for (std::uint32_t level = 1; level < kLevels; ++level) {
        bool any = false;
        for (std::uint32_t f = 0; f < kFaces; ++f) {
            const IzbFace& face = grid.frame.faces[f];
            if (level >= level_count(face)) continue;
            dispatch(recorder, kernel.reduce, push.with(f, level),
                     divide_up(level_nodes(face, level), device_.subgroup_size()));
            any = true;
        }
        if (!any) break;
        recorder.barrier();
    }
    recorder.barrier();
}

void Query::record_batch(Recorder& recorder, const Push& push, const Lists& room,
                         std::uint32_t first, std::uint32_t end) {
    const Kernels& kernel = kernels();
    const std::uint32_t lanes = device_.subgroup_size();
    // As many workgroups as run at once, or one for each chunk.
    const std::uint32_t most =
        device_.info().loop_limit > 0 ? 0xffffffffu : device_.info().persistent_workgroups;
    const auto over_list = [&](const Kernel& over, std::uint32_t list, std::uint32_t capacity,
                               std::uint32_t chunk, std::uint32_t groups) {
        dispatch(recorder, kernel.plan, push.with(list, capacity, chunk, groups), 1);
        recorder.barrier();
        recorder.dispatch_indirect(over, push.with(room.unsure, room.ranges), status_,
                                   offsetof(IzbStatus, groups) + list * sizeof(glm::uvec3));
        recorder.barrier();
    };
    recorder.fill(status_, 0);
    recorder.barrier();
    dispatch(recorder, kernel.cast, push.with(first, end, room.entries),
             divide_up(end - first, lanes));
    recorder.barrier();
    over_list(kernel.test, kEntries, room.entries, chunk_entries(), most);
    over_list(kernel.ranges, kRanges, room.ranges, lanes, most);
    over_list(kernel.unsure, kUnsurePairs, room.unsure, lanes, 0xffffffffu);
}

void Query::shadow(const Points& points, const Grid& grid, QueryResult& result) {
    const Lists room = allocate_cells(grid, points.count());
    const Push push = make_push(points);
    for (std::uint32_t first = 0; first < triangle_count_;) {
        const std::uint32_t count = std::min(batch_, triangle_count_ - first);
        Recorder recorder(device_);
        if (result.passes == 0) record_binning(recorder, push, grid);
        record_batch(recorder, push, room, first, first + count);
        if (first + count == triangle_count_) {
            dispatch(recorder, kernels().answer, push.with_address(0, visible_.address()),
                     points.count() / kTilePoints);
            recorder.barrier();
        }
        device_.run(recorder);
        ++result.passes;
        const IzbStatus status = taskpool::gpu::read<IzbStatus>(status_, 1).front();
        if (status.counts[kEntries] <= room.entries && status.counts[kRanges] <= room.ranges &&
            status.counts[kUnsurePairs] <= room.unsure) {
            first += count;
            result.entries += status.counts[kEntries];
            result.ranges += status.counts[kRanges];
            result.unsure += status.counts[kUnsurePairs];
            result.tests += std::uint64_t{status.tests.y} << 32 | status.tests.x;
            result.exact_tests += std::uint64_t{status.exact_tests.y} << 32 | status.exact_tests.x;
        } else if (count > 1) {
            batch_ = divide_up(count, 2);
        } else {
            throw std::logic_error("izb: a single triangle overflows a list");
        }
    }
}

QueryResult Query::run(const Points& points, Visibility& visible) {
    QueryResult result;
    visible.words.assign(points.count() / 32, 0xffffffffu);
    if (triangle_count_ == 0 || points.valid_count() == 0) return result;
    allocate_points(points.count());
    kernels();
    const auto begin = std::chrono::steady_clock::now();
    const IzbExtents extents = find_extents(points);
    const Grid grid = make_grid(base_frame_, extents, config_.resolution);
    result.cells = grid.cell_count;
    result.incomplete = extents.unplaced;
    if (grid.cell_count > 0) {
        frame_.write(&grid.frame, sizeof(IzbFrame));
        shadow(points, grid, result);
    }
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    result.milliseconds = time.count();
    if (grid.cell_count > 0)
        visible.words = taskpool::gpu::read<std::uint32_t>(visible_, points.count() / 32);
    return result;
}

}  // namespace shadows::izb
