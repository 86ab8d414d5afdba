// Which clusters can shadow any of the points that will be asked about: the others need not be in
// the tree.
//
//     Receivers receivers(device);
//     receivers.record(recorder, {frame, clusters, cluster_count, has_capsules}, points);
//     build.set_mask(receivers.mask());
//
// A map around the light holds, for each direction, the depth of the farthest point there, and a
// pyramid of maxima stands on it. A cluster stays if somewhere in what it covers, widened by
// roundings and a texel, a point is no nearer than the cluster. Points without geometry count for
// nothing.
#pragma once

#include <array>

#include "shadows/points.hpp"
#include "structures/metric_tree/metric_tree_shared.h"
#include "taskpool/gpu/recorder.hpp"

namespace shadows::metric_tree {

class Receivers {
  public:
    struct Casters {
        structures::metric_tree::LightFrame frame;
        std::uint64_t clusters;  ///< address of Cluster[count]
        std::uint32_t count;
        bool capsules;  ///< false: all are balls
    };

    explicit Receivers(taskpool::gpu::Device& device);

    /// Records the making of the map and of the mask; ends with a barrier. Allocates for `casters`.
    void record(taskpool::gpu::Recorder& recorder, const Casters& casters, const Points& points);
    /// Address of the mask: a bit per cluster, 1: may shadow a point.
    std::uint64_t mask() const { return keep_.address(); }
    std::size_t memory_bytes() const { return map_.size() + keep_.size(); }

  private:
    struct Kernels {
        taskpool::gpu::Kernel points, reduce, keep;
    };
    const Kernels& kernels(bool directional, bool capsules);

    taskpool::gpu::Device& device_;
    std::array<std::array<Kernels, 2>, 2>
        kernels_;  ///< [directional][capsules], made when first needed
    taskpool::gpu::Buffer map_, keep_;
};

}  // namespace shadows::metric_tree
