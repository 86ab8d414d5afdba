// Host side of the builds: buffers, the elements' kernel, and what links the nodes.
#include "structures/metric_tree/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "structures/geometry/corner_triangle.h"
#include "structures/metric_tree/linker.hpp"
#include "structures/metric_tree/metric.hpp"

std::span<const taskpool::gpu::Shader> structures_metric_tree_shaders();

namespace structures::metric_tree {

using namespace taskpool;

/// Kernels of one variant.
struct MetricTreeBuild::Kernels {
    gpu::Kernel elements;
    std::unique_ptr<Linker> linker;
};

MetricTreeBuild::MetricTreeBuild(gpu::Device& device, const BuildConfig& config)
    : device_(&device),
      config_(config),
      gather_(device),
      header_(device, sizeof(MetricHeader), "metric header") {}
MetricTreeBuild::~MetricTreeBuild() = default;

std::size_t MetricTreeBuild::required_bytes(std::size_t clusters, std::size_t triangles) const {
    const std::size_t per_cluster = sizeof(Cluster) + sizeof(MetricNode);
    const std::size_t linker = config_.builder == BuilderKind::insertion
                                   ? insertion_bytes(*device_, config_)
                                   : median_bytes(*device_, config_, clusters);
    return clusters * per_cluster + triangles * sizeof(geometry::CornerTriangle) +
           sizeof(MetricHeader) + linker;
}

void MetricTreeBuild::prepare(const Clustering& clustering, const geometry::TriangleMesh& mesh) {
    const std::size_t count = clustering.clusters.size();
    if (count >= kLinkMask)
        throw std::invalid_argument(
            fmt::format("{} clusters: a metric tree holds less than {}", count, kLinkMask));
    cluster_count_ = static_cast<std::uint32_t>(count);
    capsules_ = std::any_of(clustering.clusters.begin(), clustering.clusters.end(),
                            [](const Cluster& cluster) { return cluster.a != cluster.b; });
    bounds_ = mesh.bounds();
    active_ = nullptr;
    clusters_ = gpu::make_buffer<Cluster>(*device_, clustering.clusters, "clusters");
    nodes_ = gpu::Buffer(*device_, count * sizeof(MetricNode), "metric nodes");

    const auto order = gpu::make_buffer<std::uint32_t>(*device_, clustering.order, "order");
    const auto positions = gpu::make_buffer<glm::vec3>(*device_, mesh.positions, "mesh positions");
    const auto corners = gpu::make_buffer<glm::uvec3>(*device_, mesh.triangles, "mesh triangles");
    triangles_ = gpu::Buffer(*device_, clustering.order.size() * sizeof(geometry::CornerTriangle),
                             "cluster triangles");
    gpu::Recorder recorder(*device_);
    gather_.record(recorder,
                   {order.address(), positions.address(), corners.address(), triangles_.address(),
                    static_cast<std::uint32_t>(clustering.order.size()),
                    static_cast<std::uint32_t>(mesh.triangle_count())});
    recorder.barrier();
    device_->run(recorder);
}

void MetricTreeBuild::load(const Tree& tree) {
    if (tree.nodes.size() != cluster_count_)
        throw std::invalid_argument(fmt::format("metric tree: {} nodes for {} prepared clusters",
                                                tree.nodes.size(), cluster_count_));
    MetricHeader header = tree.header;
    std::vector<MetricNode> nodes = tree.nodes;
    header.special = 0;
    for (const std::uint32_t id : tree.special) {
        nodes[id] = special_node(header.special);
        header.special = id + 1;
    }
    header_.write(&header, sizeof(header));
    nodes_.write(nodes.data(), nodes.size() * sizeof(MetricNode));
}

void MetricTreeBuild::restart() {
    MetricHeader header{};
    header.frame = frame();
    header.cluster_count = cluster_count_;
    header_.write(&header, sizeof(header));

    const Variant variant{header.frame.directional != 0, capsules_};
    std::unique_ptr<Kernels>& kernels = kernels_[variant.directional][variant.capsules];
    if (!kernels)
        kernels = std::make_unique<Kernels>(
            gpu::Kernel(*device_,
                        gpu::find_shader(structures_metric_tree_shaders(),
                                         "structures/metric_tree/elements.comp"),
                        variant.constants()),
            config_.builder == BuilderKind::insertion ? make_insertion(*device_, config_, variant)
                                                      : make_median(*device_, config_, variant));
    active_ = kernels.get();
    active_->linker->restart(
        {nodes_.address(), header_.address(), cluster_count_, header.frame.delta});
    begun_ = false;
}

void MetricTreeBuild::record(gpu::Recorder& recorder) {
    if (!begun_ && cluster_count_ > 0) {
        struct {
            std::uint64_t clusters, nodes, header, keep;
            std::uint32_t count, cull_facing;
        } push{clusters_.address(), nodes_.address(),   header_.address(), keep_,
               cluster_count_,      config_.cull_facing};
        recorder.dispatch(active_->elements, push, std::min(cluster_count_ / 1024 + 1, 8192u));
        recorder.barrier();
    }
    begun_ = true;
    active_->linker->record(recorder);
}

bool MetricTreeBuild::advance() { return active_->linker->advance(); }
double MetricTreeBuild::progress() const { return active_ ? active_->linker->progress() : 0; }

LightFrame MetricTreeBuild::frame() const { return make_frame(light_, bounds_); }

MetricTreeView MetricTreeBuild::view() const {
    return {header_.address(), nodes_.address(), clusters_.address(), triangles_.address()};
}

const pool::PoolStatus& MetricTreeBuild::status() const {
    static const pool::PoolStatus kNotRun;
    return active_ ? active_->linker->status() : kNotRun;
}

MetricHeader MetricTreeBuild::header() const { return gpu::read<MetricHeader>(header_, 1)[0]; }

Tree MetricTreeBuild::read_back() const {
    Tree tree{header(), gpu::read<MetricNode>(nodes_, cluster_count_), {}};
    tree.header.root &= kLinkMask;
    for (std::uint32_t link = tree.header.special;
         link != 0 && tree.special.size() < tree.header.special_count;
         link = tree.nodes[link - 1].over)
        tree.special.push_back(link - 1);
    for (MetricNode& node : tree.nodes)
        for (std::uint32_t* link : {&node.near, &node.far, &node.over}) *link &= kLinkMask;
    return tree;
}

}  // namespace structures::metric_tree
