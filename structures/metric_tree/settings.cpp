#include "structures/metric_tree/settings.hpp"

#include "structures/metric_tree/cluster_build.hpp"

namespace structures::metric_tree {

std::vector<Parameter> tree_parameters() {
    return {
        {"build",
         std::string("insertion"),
         "how the tree is built: on the GPU, or on the CPU",
         {"insertion", "median", "cost", "cpu_median", "cpu_cost"}},
        {"cluster_size", std::int64_t{16}, "triangles in a cluster at most", {}, 1, 64},
        {"clustering",
         std::string("cpu"),
         "where triangles are clustered, once per mesh",
         {"cpu", "gpu"}},
        {"capsules", true, "long clusters become capsules, not balls"},
        {"cull_facing", false,
         "leave out clusters that face away from the light: for closed meshes of one winding"},
        {"seed", std::int64_t{1}, "of the clustering and of the order of insertion"},
        {"policy", std::string("bitmap"), "how the task pool schedules", {"bitmap", "scan"}},
        {"slots", std::int64_t{4096}, "slots of the task pool to begin with", {}, 64, 1 << 24},
        {"workgroups",
         std::int64_t{0},
         "persistent workgroups (0: as many as the device keeps busy)",
         {},
         0,
         65535},
    };
}

namespace {

ClusterConfig cluster_config(const Settings& settings) {
    ClusterConfig config;
    config.max_triangles = static_cast<std::uint32_t>(settings.integer("cluster_size"));
    config.capsules = settings.boolean("capsules");
    config.seed = static_cast<std::uint64_t>(settings.integer("seed"));
    return config;
}

}  // namespace

Clustering make_clusters(taskpool::gpu::Device& device, const geometry::TriangleMesh& mesh,
                         const Settings& settings) {
    const ClusterConfig config = cluster_config(settings);
    if (settings.text("clustering") == "cpu") return cluster(mesh, config);
    ClusterBuild build(device, config);
    build.prepare(mesh);
    taskpool::pool::run(device, build);
    return build.read_back();
}

BuildConfig build_config(const Settings& settings) {
    BuildConfig config;
    const std::string& build = settings.text("build");
    if (build == "median") config.builder = BuilderKind::median;
    if (build == "cost") config.builder = BuilderKind::cost;
    config.cull_facing = settings.boolean("cull_facing");
    config.seed = static_cast<std::uint64_t>(settings.integer("seed"));
    config.pool.policy = taskpool::pool::policy_from(settings.text("policy"));
    config.pool.slots = static_cast<std::uint32_t>(settings.integer("slots"));
    config.pool.subgroups = static_cast<std::uint32_t>(settings.integer("workgroups"));
    return config;
}

std::optional<ReferenceConfig> reference_config(const Settings& settings) {
    const std::string& build = settings.text("build");
    if (!build.starts_with("cpu_")) return std::nullopt;
    ReferenceConfig config;
    config.split = build == "cpu_cost" ? Split::cost : Split::median;
    config.cull_facing = settings.boolean("cull_facing");
    config.seed = static_cast<std::uint64_t>(settings.integer("seed"));
    return config;
}

}  // namespace structures::metric_tree
