// What this folder adds to the registry of structures: the metric tree of a mesh for one light.
#include "structures/hash.hpp"
#include "structures/metric_tree/settings.hpp"
#include "structures/structure.hpp"

namespace structures::metric_tree {
namespace {

std::span<const Parameter> parameters() {
    static const std::vector<Parameter> all = [] {
        std::vector<Parameter> list = tree_parameters();
        const Parameter light[] = {
            {"light_x", 0.5, "the light's place in the mesh's box: 0 to 1 is inside"},
            {"light_y", 2.0, "likewise"},
            {"light_z", 0.5, "likewise"},
            {"directional", false, "light comes from there, for all of the mesh alike"},
        };
        list.insert(list.end(), std::begin(light), std::end(light));
        return list;
    }();
    return all;
}

class MetricTreeBuilder final : public Builder {
  public:
    MetricTreeBuilder(taskpool::gpu::Device& device, const Settings& settings)
        : device_(device),
          settings_(settings),
          place_(settings.real("light_x"), settings.real("light_y"), settings.real("light_z")),
          directional_(settings.boolean("directional")),
          build_(device, build_config(settings)) {
        if (const auto config = reference_config(settings)) host_.emplace(build_, *config);
    }

    /// A cluster holds one triangle at least.
    std::size_t required_bytes(std::size_t triangle_count) const override {
        return build_.required_bytes(triangle_count, triangle_count);
    }
    void prepare(const geometry::TriangleMesh& mesh) override {
        triangle_count_ = mesh.triangle_count();
        clustering_ = make_clusters(device_, mesh, settings_);
        build_.prepare(clustering_, mesh);
        const geometry::Light light = light_for(mesh.bounds());
        build_.set_light(light);
        if (host_) host_->prepare(clustering_, mesh.bounds(), light);
    }
    taskpool::pool::Job& job() override {
        return host_ ? static_cast<taskpool::pool::Job&>(*host_) : build_;
    }

    Samples metrics() override {
        const Tree tree = build_.read_back();
        const MetricHeader& header = tree.header;
        const TreeQuality quality = measure(tree);
        const double clusters = header.cluster_count;
        Samples samples{{"nodes", double(quality.nodes)},
                        {"depth_max", double(quality.depth_max)},
                        {"depth_mean", quality.depth_mean},
                        {"casters_total", clusters},
                        {"casters_inserted", double(header.inserted)},
                        {"capsule_share", clusters > 0 ? clustering_.capsule_count / clusters : 0},
                        {"special_clusters", double(header.special_count)},
                        {"bucketed_clusters", double(header.bucketed)},
                        {"degenerate", double(triangle_count_ - clustering_.order.size())}};
        if (!host_) {
            const taskpool::pool::PoolStatus& status = build_.status();
            samples.push_back({"tasks", double(status.state.spawned) + 1});
            samples.push_back({"pool_peak", double(status.state.peak_live)});
        }
        return samples;
    }
    std::vector<std::string> validate() override {
        return metric_tree::validate(clustering_, build_.read_back());
    }
    /// 0 for insertion, whose trees depend on who came first.
    std::uint64_t fingerprint() override {
        if (!host_ && build_.config().builder == BuilderKind::insertion) return 0;
        Hash hash;
        const Tree tree = build_.read_back();
        hash.add(tree.header);
        for (const MetricNode& node : tree.nodes) hash.add(node);
        return hash.value();
    }

  private:
    /// The CPU builders: the whole build happens when the (empty) launch has finished.
    class HostBuild final : public taskpool::pool::Job {
      public:
        HostBuild(MetricTreeBuild& target, const ReferenceConfig& config)
            : target_(target), config_(config) {}
        void prepare(const Clustering& clustering, const geometry::Aabb& bounds,
                     const geometry::Light& light) {
            clustering_ = &clustering;
            bounds_ = bounds;
            light_ = light;
        }
        void restart() override {}
        void record(taskpool::gpu::Recorder&) override {}
        bool advance() override {
            target_.load(build_reference(*clustering_, bounds_, light_, config_));
            return false;
        }

      private:
        MetricTreeBuild& target_;
        ReferenceConfig config_;
        const Clustering* clustering_ = nullptr;
        geometry::Aabb bounds_;
        geometry::Light light_;
    };

    geometry::Light light_for(const geometry::Aabb& bounds) const {
        const geometry::Aabb box =
            bounds.empty() ? geometry::Aabb{glm::vec3(0), glm::vec3(1)} : bounds;
        const glm::vec3 place = box.lower + glm::vec3(place_) * box.extent();
        if (!directional_) return {geometry::Light::Type::point, place};
        return {geometry::Light::Type::directional, box.center() - place};
    }

    taskpool::gpu::Device& device_;
    Settings settings_;
    glm::dvec3 place_;
    bool directional_;
    MetricTreeBuild build_;
    std::optional<HostBuild> host_;
    Clustering clustering_;
    std::size_t triangle_count_ = 0;
};

std::unique_ptr<Builder> create(taskpool::gpu::Device& device, const Settings& settings) {
    return std::make_unique<MetricTreeBuilder>(device, settings);
}

}  // namespace

std::span<const StructureRow> rows() {
    static const StructureRow all[] = {
        {"metric_tree", "ternary metric tree over clusters of triangles, for one light",
         &parameters, &create}};
    return all;
}

}  // namespace structures::metric_tree
