#include "structures/bvh/reference_builder.hpp"

#include <stdexcept>

#include "structures/bvh/fingerprint.hpp"
#include "structures/bvh/quality.hpp"
#include "structures/bvh/validate.hpp"

namespace structures::bvh {
namespace {

std::unique_ptr<Builder> create(taskpool::gpu::Device&, const Settings& settings) {
    return std::make_unique<ReferenceBuilder>(reference_config(settings));
}

}  // namespace

std::span<const Parameter> reference_parameters() {
    static const Parameter parameters[] = {
        {"rule",
         std::string("sweep_sah"),
         "split rule",
         {"sweep_sah", "object_median", "spatial_median"}},
        {"leaf_rule",
         std::string("sah"),
         "when a range of at most max_leaf_size triangles becomes a leaf: when cheaper, or always",
         {"sah", "count"}},
        {"max_leaf_size", std::int64_t{4}, "triangles per leaf at most", {}, 1, 1 << 20},
        {"traversal_cost", 3.0, "SAH cost of visiting an inner node", {}, 0, 1e6},
        {"intersection_cost", 2.0, "SAH cost of testing a triangle", {}, 1e-6, 1e6},
        {"threads", std::int64_t{0}, "threads (0: all cores)", {}, 0, 1024},
    };
    return parameters;
}

ReferenceConfig reference_config(const Settings& settings) {
    ReferenceConfig config;
    const std::string& rule = settings.text("rule");
    config.rule = rule == "object_median"    ? SplitRule::object_median
                  : rule == "spatial_median" ? SplitRule::spatial_median
                                             : SplitRule::sweep_sah;
    config.leaf_rule = settings.text("leaf_rule") == "count" ? LeafRule::count : LeafRule::sah;
    config.max_leaf_size = static_cast<std::uint32_t>(settings.integer("max_leaf_size"));
    config.costs = {settings.real("traversal_cost"), settings.real("intersection_cost")};
    config.threads = static_cast<unsigned>(settings.integer("threads"));
    return config;
}

bool ReferenceBuilder::BuildJob::advance() {
    if (!mesh) throw std::logic_error("bvh_reference: job run before prepare()");
    tree = build_reference(*mesh, config);
    return false;
}

void ReferenceBuilder::prepare(const geometry::TriangleMesh& mesh) {
    job_.mesh = &mesh;
    job_.tree = {};
}

const Tree& ReferenceBuilder::tree() const {
    if (job_.tree.nodes.empty()) throw std::logic_error("bvh_reference: not built yet");
    return job_.tree;
}

Samples ReferenceBuilder::metrics() {
    return to_samples(measure(*job_.mesh, tree(), {.costs = job_.config.costs}));
}

std::vector<std::string> ReferenceBuilder::validate() {
    return bvh::validate(*job_.mesh, tree(),
                         {.max_leaf_size = job_.config.max_leaf_size,
                          .max_depth = job_.config.max_depth,
                          .tight = true});
}

std::uint64_t ReferenceBuilder::fingerprint() { return bvh::fingerprint(tree()); }

const StructureRow kReferenceRow = {
    "bvh_reference", "binary BVH built on the CPU: sweep SAH, object median or spatial median",
    &reference_parameters, &create};

}  // namespace structures::bvh
