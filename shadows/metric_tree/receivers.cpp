#include "shadows/metric_tree/receivers.hpp"

#include <algorithm>

#include "shadows/metric_tree/receivers_shared.h"

std::span<const taskpool::gpu::Shader> shadows_metric_tree_shaders();

namespace shadows::metric_tree {
namespace {

struct Push {
    structures::metric_tree::LightFrame frame;
    std::uint64_t map, points, clusters, keep;
    std::uint32_t count, level;
};

/// Workgroups over `items`, a lane each.
std::uint32_t groups(std::uint32_t items) { return std::clamp(items / 1024, 1u, 8192u); }

}  // namespace

Receivers::Receivers(taskpool::gpu::Device& device)
    : device_(device), map_(device, std::size_t{kFaces} * kFaceTexels * 4, "map of receivers") {}

const Receivers::Kernels& Receivers::kernels(bool directional, bool capsules) {
    Kernels& found = kernels_[directional][capsules];
    const auto make = [&](const char* name) {
        return taskpool::gpu::Kernel(
            device_, taskpool::gpu::find_shader(shadows_metric_tree_shaders(), name),
            {{1, directional}, {24, capsules}});
    };
    if (!found.points.handle())
        found = {make("shadows/metric_tree/receivers_points.comp"),
                 make("shadows/metric_tree/receivers_reduce.comp"),
                 make("shadows/metric_tree/receivers_keep.comp")};
    return found;
}

void Receivers::record(taskpool::gpu::Recorder& recorder, const Casters& casters,
                       const Points& points) {
    const std::size_t mask_bytes = (casters.count + 31) / 32 * 4;
    if (keep_.size() < mask_bytes)
        keep_ = taskpool::gpu::Buffer(device_, mask_bytes, "mask of clusters to keep");
    const bool directional = casters.frame.directional != 0;
    const Kernels& kernel = kernels(directional, casters.capsules);
    Push push{casters.frame,
              map_.address(),
              points.address(),
              casters.clusters,
              keep_.address(),
              points.count(),
              0};
    recorder.fill(map_, 0);
    recorder.barrier();
    recorder.dispatch(kernel.points, push, groups(push.count));
    recorder.barrier();
    for (push.level = 1; push.level < kMapLevels; ++push.level) {
        const std::uint32_t side = kMapSide >> push.level;
        push.count = (directional ? 1 : kFaces) * side * side;
        recorder.dispatch(kernel.reduce, push, groups(push.count));
        recorder.barrier();
    }
    push.count = casters.count;
    recorder.dispatch(kernel.keep, push, groups(casters.count / 32 + 1));
    recorder.barrier();
}

}  // namespace shadows::metric_tree
