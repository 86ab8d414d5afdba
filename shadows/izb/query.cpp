#include "shadows/izb/query.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

std::span<const taskpool::gpu::Shader> shadows_izb_shaders();

namespace shadows::izb {

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

    Push with(std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0) const {
        Push copy = *this;
        copy.job = {x, y, z, 0};
        return copy;
    }
    Push with_address(std::uint32_t x, std::uint64_t address) const {
        Push copy = *this;
        copy.job = {x, 0, std::uint32_t(address), std::uint32_t(address >> 32)};
        return copy;
    }
};

namespace {

/// As triangles lie on the device; see frame.glsl.
struct DeviceTriangle {
    glm::vec3 a, b, c;
    std::uint32_t primitive;
};
constexpr std::size_t kBinnedBytes = 16;

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

constexpr std::uint32_t kMaxGroups = 32768;  // of one dimension of a dispatch
constexpr std::uint32_t kRunPoints = 4096;   // of one workgroup that goes through the points

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
      times_(device, 2),
      frame_(device, sizeof(IzbFrame), "izb frame"),
      extents_(device, sizeof(Extents), "izb extents"),
      status_(device, sizeof(IzbStatus), "izb status") {}

void Query::prepare(const TriangleMesh& mesh) {
    std::vector<DeviceTriangle> triangles;
    bounds_ = {};
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const glm::vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        if (!finite(a) || !finite(b) || !finite(c) || mesh.degenerate(t)) continue;
        triangles.push_back({a, b, c, t});
        for (const glm::vec3& corner : {a, b, c}) bounds_.grow(corner);
    }
    if (triangles.size() >= 1u << 29)
        throw std::invalid_argument("izb: 2^29 triangles or more; use fewer");
    triangle_count_ = static_cast<std::uint32_t>(triangles.size());
    triangles_ = taskpool::gpu::make_buffer<DeviceTriangle>(device_, triangles, "izb triangles");
}

void Query::set_light(const Light& light) {
    if (!finite(light.vector))
        throw std::invalid_argument("izb: the light's vector is not finite; give finite numbers");
    if (light.type == Light::Type::directional && light.vector == glm::vec3(0))
        throw std::invalid_argument("izb: the light's direction is 0; give any other");
    light_ = light;
    if (triangle_count_ > 0) base_frame_ = make_frame(bounds_, light);
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
             kernel("shadows/izb/answer.comp")};
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

void Query::submit(QueryResult& result, const std::function<void(Recorder&)>& record) {
    times_.clear();
    Recorder recorder(device_);
    recorder.timestamp(times_, "begin");
    record(recorder);
    recorder.barrier();
    recorder.timestamp(times_, "end");
    device_.run(recorder);
    result.milliseconds += times_.milliseconds("begin", "end");
}

void Query::allocate_points(std::uint32_t count) {
    for (Buffer* buffer : {&places_, &order_})
        grow(device_, *buffer, std::size_t{count} * 4, "izb points");
    // Becomes the list of unsure pairs. One triangle alone always finds room: no two of its entries
    // share a cell, so that it meets no point twice.
    grow(device_, keys_, std::size_t{count} * 8, "izb keys");
    grow(device_, binned_, count * kBinnedBytes, "izb binned points");
    grow(device_, visible_, count / 8, "visibility");
}

void Query::allocate_cells(const Grid& grid) {
    const std::uint32_t cells = grid.frame.cell_count;
    grow(device_, cells_, (std::size_t{cells} + 1) * 4, "izb cells");
    grow(device_, farthest_, std::size_t{grid.node_count} * 4, "izb pyramid");
    grow(device_, scratch_, scan_.scratch_bytes(cells + 1), "izb scratch");
    // One triangle alone always finds room: an entry for each row of tiles and kRowCells cells of
    // it, and a range for each cell and another for each kRangePoints points.
    const std::size_t blocks =
        kFaces * std::size_t{kMaxResolution >> kTileLog} * ((kMaxResolution / kRowCells) + 1);
    const std::size_t entries =
        config_.entries > 0 ? config_.entries : 4 * std::size_t{triangle_count_};
    grow(device_, entries_, std::max(entries, blocks) * sizeof(IzbEntry), "izb entries");
    const std::size_t pieces = cells + keys_.size() / 8 / kRangePoints + 1;
    grow(device_, ranges_, std::max<std::size_t>(config_.ranges, pieces) * sizeof(IzbRange),
         "izb ranges");
}

Grid Query::bin(const Points& points, QueryResult& result) {
    const std::uint32_t count = points.count(), runs = divide_up(count, kRunPoints);
    const Kernels& kernel = kernels();
    frame_.write(&base_frame_, sizeof(IzbFrame));
    submit(result, [&](Recorder& recorder) {
        recorder.fill(extents_, 0);
        recorder.barrier();
        dispatch(recorder, kernel.bounds,
                 make_push(points).with_address(kRunPoints, extents_.address()), runs);
    });
    Extents extents;
    extents_.read(&extents, sizeof(extents));
    const Grid grid = make_grid(base_frame_, extents, config_.resolution);
    frame_.write(&grid.frame, sizeof(IzbFrame));
    allocate_cells(grid);
    result.cells = grid.frame.cell_count;
    submit(result, [&](Recorder& recorder) {
        const Push push = make_push(points).with(kRunPoints);
        recorder.fill(cells_, 0);
        recorder.fill(farthest_, 0xffffffffu);
        recorder.barrier();
        dispatch(recorder, kernel.count, push, runs);
        recorder.barrier();
        scan_.record(recorder, cells_, cells_, grid.frame.cell_count + 1, scratch_);
        dispatch(recorder, kernel.scatter, push, runs);
        for (std::uint32_t level = 1; level < grid.level_count; ++level) {
            for (std::uint32_t f = 0; f < kFaces; ++f) {
                const IzbFace& face = grid.frame.faces[f];
                if (level >= face.level_count) continue;
                const std::uint32_t nodes = 1u << (std::max(face.log_width, level) - level +
                                                   std::max(face.log_height, level) - level);
                dispatch(recorder, kernel.reduce, push.with(f, level),
                         divide_up(nodes, device_.subgroup_size()));
            }
            recorder.barrier();
        }
    });
    return grid;
}

bool Query::shadow_batch(const Push& push, std::uint32_t first, std::uint32_t count,
                         QueryResult& result) {
    const std::uint32_t lanes = device_.subgroup_size();
    const std::uint32_t entry_capacity = std::uint32_t(entries_.size() / sizeof(IzbEntry));
    const std::uint32_t range_capacity = std::uint32_t(ranges_.size() / sizeof(IzbRange));
    const std::uint32_t unsure_capacity = push.point_count;
    const Kernels& kernel = kernels();
    // Workgroups over chunks of `items`: as many as run at once, or one for each chunk.
    const auto groups = [&](std::uint32_t items, std::uint32_t chunk) {
        const std::uint32_t chunks = divide_up(items, chunk);
        if (device_.info().loop_limit > 0) return chunks;
        return std::min(chunks, device_.info().persistent_workgroups);
    };
    const auto status = [&] { return taskpool::gpu::read<IzbStatus>(status_, 1).front(); };
    ++result.passes;
    submit(result, [&](Recorder& recorder) {
        recorder.fill(status_, 0);
        recorder.barrier();
        dispatch(recorder, kernel.cast, push.with(first, first + count, entry_capacity),
                 divide_up(count, lanes));
    });
    const std::uint32_t entries = status().entry_count;
    if (entries > entry_capacity) return false;
    if (entries == 0) return true;
    submit(result, [&](Recorder& recorder) {
        dispatch(recorder, kernel.test, push.with(entries, unsure_capacity, range_capacity),
                 groups(entries, chunk_entries()));
    });
    const std::uint32_t ranges = status().range_count;
    if (ranges > range_capacity) return false;
    if (ranges > 0)
        submit(result, [&](Recorder& recorder) {
            dispatch(recorder, kernel.ranges, push.with(ranges, unsure_capacity),
                     groups(ranges, lanes));
        });
    const IzbStatus end = status();
    if (end.unsure_count > unsure_capacity) return false;
    if (end.unsure_count > 0)
        submit(result, [&](Recorder& recorder) {
            dispatch(recorder, kernel.unsure, push.with(end.unsure_count),
                     divide_up(end.unsure_count, lanes));
        });
    result.unsure += end.unsure_count;
    result.entries += entries;
    result.ranges += ranges;
    result.tests += std::uint64_t{end.tests.y} << 32 | end.tests.x;
    result.exact_tests += std::uint64_t{end.exact_tests.y} << 32 | end.exact_tests.x;
    return true;
}

void Query::shadow(const Points& points, QueryResult& result) {
    const Push push = make_push(points);
    std::uint32_t batch = triangle_count_;
    for (std::uint32_t first = 0; first < triangle_count_;) {
        const std::uint32_t count = std::min(batch, triangle_count_ - first);
        if (shadow_batch(push, first, count, result)) {
            first += count;
        } else if (count > 1) {
            batch = divide_up(count, 2);
        } else {
            throw std::logic_error("izb: a single triangle overflows a list");
        }
    }
}

QueryResult Query::run(const Points& points, Visibility& visible) {
    QueryResult result;
    if (triangle_count_ == 0 || points.valid_count() == 0) {
        visible.words.assign(points.count() / 32, 0xffffffffu);
        return result;
    }
    allocate_points(points.count());
    const Grid grid = bin(points, result);
    if (grid.frame.cell_count > 0) shadow(points, result);
    submit(result, [&](Recorder& recorder) {
        dispatch(recorder, kernels().answer, make_push(points).with_address(0, visible_.address()),
                 points.count() / kTilePoints);
    });
    visible.words = taskpool::gpu::read<std::uint32_t>(visible_, points.count() / 32);
    return result;
}

}  // namespace shadows::izb
