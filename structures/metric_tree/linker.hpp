// How the nodes of a metric tree come to be linked: a client of the task pool per kind of builder.
#pragma once

#include <memory>

#include "structures/metric_tree/build.hpp"

namespace structures::metric_tree {

/// What the kernels are specialised for.
struct Variant {
    bool directional = false;
    bool capsules = true;  ///< false: all clusters are balls
    std::vector<taskpool::gpu::Constant> constants() const {
        return {{16, directional}, {17, capsules}};
    }
};

/// The nodes to link, as elements.comp leaves them: device addresses of MetricNode[] and
/// MetricHeader.
struct LinkInput {
    std::uint64_t nodes = 0, header = 0;
    std::uint32_t cluster_count = 0;
    float delta = 0;  ///< LightFrame::delta
};

class Linker {
  public:
    virtual ~Linker() = default;
    /// The methods of a pool::Job.
    virtual void restart(const LinkInput& input) = 0;
    virtual void record(taskpool::gpu::Recorder& recorder) = 0;
    virtual bool advance() = 0;
    virtual double progress() const = 0;
    virtual const taskpool::pool::PoolStatus& status() const = 0;
};

/// insertion.comp.
std::unique_ptr<Linker> make_insertion(taskpool::gpu::Device& device, const BuildConfig& config,
                                       const Variant& variant);
/// Bytes of device memory that it takes, before its pool grows.
std::size_t insertion_bytes(const taskpool::gpu::Device& device, const BuildConfig& config);

/// median.comp, by median or by cost.
std::unique_ptr<Linker> make_median(taskpool::gpu::Device& device, const BuildConfig& config,
                                    const Variant& variant);
/// Likewise: two numbers per cluster, and a little per chunk of them.
std::size_t median_bytes(const taskpool::gpu::Device& device, const BuildConfig& config,
                         std::size_t clusters);

}  // namespace structures::metric_tree
