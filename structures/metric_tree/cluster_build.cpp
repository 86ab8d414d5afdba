// Host side: what is launched in which order.
#include "structures/metric_tree/cluster_build.hpp"

#include <algorithm>

std::span<const taskpool::gpu::Shader> structures_metric_tree_shaders();

namespace structures::metric_tree {
namespace {

using namespace taskpool;

constexpr std::uint32_t kChunk = 512, kMeans = 8, kLoops = 32;  // as in cluster_split.comp
constexpr std::uint32_t kCodeBits = 48;

// The kernel's struct Task and struct Client.
struct Task {
    std::uint32_t first, count, part_count, begins[kMeans], ends[kMeans];
};
struct Client {
    std::uint64_t positions, triangles, order, marks, kept;
    std::uint32_t seed, max_triangles;
};

const gpu::Shader& shader(const char* name) {
    return gpu::find_shader(structures_metric_tree_shaders(),
                            std::string("structures/metric_tree/") + name);
}

pool::ClientSpec client_spec(const gpu::Device& device) {
    // Loading; five times each mean for each triangle, four times again to move the means, once to
    // gather; and the means' beginnings.
    const std::uint32_t groups = kChunk / device.subgroup_size() + 1;
    return {.task_bytes = sizeof(Task),
            .chunk_iterations = groups * (2 + 5 * (kMeans + 1) + 5 * kMeans) + 1024,
            .loops = kLoops};
}

std::uint32_t groups_for(const gpu::Device& device, std::uint32_t count) {
    const std::uint32_t lanes = device.subgroup_size();
    return std::min((count + lanes - 1) / lanes, 65535u);
}

}  // namespace

ClusterBuild::ClusterBuild(gpu::Device& device, const ClusterConfig& config,
                           const pool::PoolConfig& pool)
    : device_(&device),
      config_(config),
      codes_kernel_(device, shader("cluster_codes.comp")),
      fit_kernel_(device, shader("cluster_fit.comp"), {{16, config.capsules}}),
      sort_(device, primitives::RadixSort::Key::u64),
      compact_(device),
      pool_(device, shader("cluster_split.comp"), client_spec(device), pool),
      counts_(device, 2 * sizeof(std::uint32_t), "cluster counts") {
    check(config);
}

void ClusterBuild::prepare(const geometry::TriangleMesh& mesh) {
    check(mesh);
    const std::size_t count = mesh.triangle_count();
    triangle_count_ = static_cast<std::uint32_t>(count);
    cluster_count_ = 0;
    stage_ = Stage::done;
    bounds_ = mesh.bounds();
    positions_ = gpu::make_buffer<glm::vec3>(*device_, mesh.positions, "mesh positions");
    triangles_ = gpu::make_buffer<glm::uvec3>(*device_, mesh.triangles, "mesh triangles");
    codes_ = gpu::Buffer(*device_, count * 8, "Morton codes");
    sorted_codes_ = gpu::Buffer(*device_, count * 8, "sorted Morton codes");
    ids_ = gpu::Buffer(*device_, count * 4, "triangles");
    order_ = gpu::Buffer(*device_, count * 4, "triangles of clusters");
    marks_ = gpu::Buffer(*device_, count * 4, "cluster marks");
    firsts_ = gpu::Buffer(*device_, count * 4, "cluster firsts");
    scratch_ = gpu::Buffer(
        *device_,
        std::max(sort_.scratch_bytes(triangle_count_), compact_.scratch_bytes(triangle_count_)),
        "cluster scratch");
}

void ClusterBuild::restart() {
    cluster_count_ = 0;
    stage_ = triangle_count_ > 0 ? Stage::sort : Stage::done;
    pool_.restart(pool::RootStart{}, Task{});
}

void ClusterBuild::record_sort(gpu::Recorder& recorder) {
    const glm::vec3 extent = bounds_.extent();
    const float largest = std::max({extent.x, extent.y, extent.z});
    const struct {
        std::uint64_t positions, triangles, codes, ids, kept;
        std::uint32_t count;
        glm::vec3 lower;
        float inverse;
    } push{positions_.address(), triangles_.address(),
           codes_.address(),     ids_.address(),
           counts_.address(),    triangle_count_,
           bounds_.lower,        largest > 0 ? 1 / largest : 0};
    recorder.fill(counts_, 0);
    recorder.fill(marks_, 0);
    recorder.barrier();
    recorder.dispatch(codes_kernel_, push, groups_for(*device_, triangle_count_));
    recorder.barrier();
    sort_.record(recorder,
                 {codes_, ids_, sorted_codes_, order_, scratch_, triangle_count_, kCodeBits});
}

void ClusterBuild::record_fit(gpu::Recorder& recorder) {
    const struct {
        std::uint64_t positions, triangles, order, firsts, marks, clusters;
        std::uint32_t count;
    } push{positions_.address(), triangles_.address(), order_.address(), firsts_.address(),
           marks_.address(),     clusters_.address(),  cluster_count_};
    recorder.dispatch(fit_kernel_, push, groups_for(*device_, cluster_count_));
    recorder.barrier();
}

void ClusterBuild::record(gpu::Recorder& recorder) {
    switch (stage_) {
        case Stage::sort:
            record_sort(recorder);
            [[fallthrough]];
        case Stage::split:
            pool_.record(recorder,
                         Client{positions_.address(), triangles_.address(), order_.address(),
                                marks_.address(), counts_.address(),
                                static_cast<std::uint32_t>(config_.seed ^ (config_.seed >> 32)),
                                config_.max_triangles});
            break;
        case Stage::list:
            compact_.record(recorder, marks_, {}, firsts_, primitives::Range(counts_).from(4),
                            triangle_count_, scratch_);
            break;
        case Stage::fit:
            record_fit(recorder);
            break;
        case Stage::done:
            break;
    }
}

bool ClusterBuild::advance() {
    switch (stage_) {
        case Stage::sort:
        case Stage::split:
            stage_ = pool_.advance() ? Stage::split : Stage::list;
            break;
        case Stage::list:
            cluster_count_ = gpu::read<std::uint32_t>(counts_, 1, 1).front();
            clusters_ = gpu::Buffer(*device_, cluster_count_ * sizeof(Cluster), "clusters");
            stage_ = cluster_count_ > 0 ? Stage::fit : Stage::done;
            break;
        case Stage::fit:
        case Stage::done:
            stage_ = Stage::done;
            break;
    }
    return stage_ != Stage::done;
}

double ClusterBuild::progress() const {
    return stage_ == Stage::done ? 1
                                 : 0.9 * static_cast<double>(status().state.progress) /
                                       static_cast<double>(triangle_count_);
}

Clustering ClusterBuild::read_back() const {
    Clustering result;
    if (cluster_count_ == 0) return result;
    result.clusters = gpu::read<Cluster>(clusters_, cluster_count_);
    result.order = gpu::read<std::uint32_t>(order_, gpu::read<std::uint32_t>(counts_, 1).front());
    result.capsule_count = count_capsules(result.clusters);
    return result;
}

}  // namespace structures::metric_tree
