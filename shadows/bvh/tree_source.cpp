#include "shadows/bvh/tree_source.hpp"

#include <chrono>

#include "structures/bvh/gpu_builder.hpp"

namespace shadows::bvh {

using namespace structures::bvh;
using structures::Parameter;
using structures::Settings;

std::vector<Parameter> tree_parameters() {
    std::vector<Parameter> all = {
        {"build",
         std::string("binned_sah"),
         "how the tree is built: binned_sah, spatial_median on the GPU; the others on the CPU",
         {"binned_sah", "spatial_median", "sweep_sah", "object_median"}}};
    for (const Parameter& parameter : build_parameters())
        if (parameter.name != "split") all.push_back(parameter);
    return all;
}

namespace {

Config gpu_config(const Settings& settings) {
    std::map<std::string, structures::Value> values{{"split", settings.text("build")}};
    for (const Parameter& parameter : build_parameters())
        if (parameter.name != "split") values.insert(*settings.values().find(parameter.name));
    return build_config(Settings::resolve(build_parameters(), values));
}

}  // namespace

TreeSource::TreeSource(taskpool::gpu::Device& device, const Settings& settings) : device_(device) {
    const std::string& build = settings.text("build");
    if (build == "binned_sah" || build == "spatial_median") {
        gpu_.emplace(device, gpu_config(settings));
        return;
    }
    reference_.rule = build == "sweep_sah" ? SplitRule::sweep_sah : SplitRule::object_median;
    reference_.leaf_rule = settings.text("leaf_rule") == "sah" ? LeafRule::sah : LeafRule::count;
    reference_.max_leaf_size = static_cast<std::uint32_t>(settings.integer("max_leaf_size"));
    reference_.costs = {settings.real("traversal_cost"), settings.real("intersection_cost")};
}

void TreeSource::prepare(const structures::geometry::TriangleMesh& mesh) {
    mesh_ = &mesh;
    if (gpu_) {
        gpu_->prepare(mesh);
        return;
    }
    positions_ = taskpool::gpu::make_buffer<glm::vec3>(device_, mesh.positions, "mesh positions");
    triangles_ = taskpool::gpu::make_buffer<glm::uvec3>(device_, mesh.triangles, "mesh triangles");
}

double TreeSource::build() {
    if (gpu_) return taskpool::pool::run(device_, *gpu_).gpu_ms;
    const auto begin = std::chrono::steady_clock::now();
    const Tree tree = build_reference(*mesh_, reference_);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    nodes_ = taskpool::gpu::make_buffer<BvhNode>(device_, tree.nodes, "BVH nodes");
    order_ = taskpool::gpu::make_buffer<std::uint32_t>(device_, tree.order, "BVH order");
    node_count_ = static_cast<std::uint32_t>(tree.nodes.size());
    order_count_ = static_cast<std::uint32_t>(tree.order.size());
    return time.count();
}

std::size_t TreeSource::memory_bytes() const {
    return gpu_ ? gpu_->required_bytes(mesh_->triangle_count()) : nodes_.size() + order_.size();
}

structures::Samples TreeSource::counters() const {
    if (!gpu_) return {};
    const taskpool::pool::PoolStatus& status = gpu_->status();
    return {{"tasks", double(status.state.spawned) + 1},
            {"launches", double(status.launches)},
            {"pool_peak", double(status.state.peak_live)}};
}

wide::BinaryTree TreeSource::tree() const {
    const auto triangles = static_cast<std::uint32_t>(mesh_->triangle_count());
    if (gpu_)
        return {gpu_->nodes().address(),     gpu_->order().address(), gpu_->positions().address(),
                gpu_->triangles().address(), gpu_->primitive_count(), triangles};
    return {nodes_.address(),     order_.address(), positions_.address(),
            triangles_.address(), order_count_,     triangles};
}

wide::Capacity TreeSource::capacity() const {
    if (gpu_) return {gpu_->primitive_count(), gpu_->node_capacity()};
    return {order_count_, node_count_};
}

}  // namespace shadows::bvh
