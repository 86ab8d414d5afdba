#include "experiments/measure/metrics.hpp"

namespace experiments::measure {
namespace {

using enum Better;

constexpr Metric kMetrics[] = {
    {"cluster_ms", "ms", lower, "time to group the triangles before the build"},
    {"build_ms", "ms", lower, "time to build the structure"},
    {"query_ms", "ms", lower, "time to answer every point"},
    {"total_ms", "ms", lower, "build_ms and query_ms of one repetition"},
    {"false_lit", "1", lower, "points wrongly found lit, outside the rounding band"},
    {"false_shadowed", "1", lower, "points wrongly found shadowed, outside the rounding band"},
    {"errors_per_million", "1", lower, "false_lit and false_shadowed per million points"},
    {"gbuffer_ms", "ms", lower, "time to rasterise the points, once per scene"},
    {"wall_ms", "ms", lower, "build by the host's clock: launches, waiting, growth"},
    {"memory_bytes", "bytes", lower, "memory at the peak of the build"},
    {"visited_nodes_mean", "1", lower, "nodes visited per point, mean"},
    {"visited_nodes_max", "1", lower, "nodes visited per point, maximum"},
    {"tested_triangles_mean", "1", lower, "triangles tested per point, mean"},
    {"exact_tests_mean", "1", lower, "exact leaf tests per point, mean"},
    {"fp64_decisions", "1", lower, "point-triangle pairs decided in double precision"},
    {"exact_decisions", "1", lower, "of these, pairs that needed error-free sums"},
    {"deferred_points", "1", lower, "points that a beam left to a walk of their own"},
    {"groups", "1", lower, "groups of points that beams walked the tree with"},
    {"faces", "1", neither, "shadow maps drawn"},
    {"cells", "1", neither, "cells that the points were binned in"},
    {"entries", "1", lower, "pairs of a triangle and a row of cells"},
    {"ranges", "1", lower, "ranges that crowded cells were cut into"},
    {"passes", "1", lower, "batches of triangles, repeated ones included"},
    {"casters_total", "1", neither, "shadow casters in the scene"},
    {"casters_inserted", "1", neither, "shadow casters that entered the structure"},
    {"special_clusters", "1", neither, "clusters around the light, or too wide for a tree"},
    {"bucketed_clusters", "1", lower, "clusters in lists at the end of long chains"},
    {"culled_facing", "1", neither, "casters left out, as they face away from the light"},
    {"culled_unseen", "1", neither, "casters left out, as they can shadow no point"},
    {"capsule_share", "1", neither, "share of the clusters that are capsules, not balls"},
    {"points", "1", neither, "points with geometry"},
    {"shadowed", "1", neither, "points found in shadow"},
    {"differing_points", "1", lower, "points answered differently from the reference method"},
    {"ambiguous", "1", neither, "points that face the light, within the rounding band"},
    {"facing_away", "1", neither, "points whose surface faces away from the light"},
    {"disagreeing_1", "1", lower, "wrong answers within the rounding band"},
    {"disagreeing_4", "1", lower, "wrong answers within 4 times the band"},
    {"disagreeing_16", "1", lower, "wrong answers within 16 times the band"},
    {"facing_away_errors", "1", lower, "points facing away, outside the band, answered wrongly"},
    {"leaks", "1", lower, "clusters of false-lit pixels, joined by sides or corners"},
    {"leak_largest", "1", lower, "false-lit pixels of the largest cluster"},
    {"claims_exact", "1", neither, "1: the method claims to be exact outside the band"},
    {"stability_passed", "1", higher, "1 if every instance of the stress test passed, else 0"},
    {"instances", "1", neither, "scenes of a stress test, each as built and varied"},
    {"instances_failed", "1", lower, "of these, with a wrong, missing or failed answer"},
    {"exceptions", "1", lower, "of these, where the method gave up with an error"},
    {"unexpected", "1", lower, "wrong answers in the band where the test demands the exact one"},
    {"slowest_ms", "ms", lower, "longest of a stress test's instances, by the host's clock"},
    {"worst_x", "1", neither, "where the worst of a stress test's wrong answers was given"},
    {"worst_y", "1", neither, "the same, y"},
    {"worst_z", "1", neither, "the same, z"},
    {"incomplete", "1", lower, "points that no answer was found for"},
    {"triangles", "1", neither, "triangles of the scene"},
    {"truth_ms", "ms", lower, "time to judge the points exactly, when that was done"},
    {"truth_filtered", "1", neither, "signs that the floating-point filter vouched for"},
    {"truth_exact", "1", neither, "signs that needed exact arithmetic"},
    {"truth_candidates", "1", neither, "triangles examined near the points' ways to the light"},
    {"truth_cached", "1", neither, "1: the truth came from the cache"},
    {"degenerate", "1", neither, "triangles without area: counted and left out"},
    {"nodes", "1", neither, "nodes of the tree"},
    {"sah_cost", "1", lower, "surface area cost, c_T = 3, c_I = 2"},
    {"sah_cost_compacted", "1", lower, "the same with subtrees turned into leaves where cheaper"},
    {"epo", "1", lower, "end-point overlap of the tree"},
    {"depth_max", "1", lower, "deepest leaf"},
    {"depth_mean", "1", lower, "mean depth of a leaf"},
    {"leaf_size_mean", "1", neither, "triangles per leaf, mean"},
    {"launches", "1", lower, "kernel launches of the task pool"},
    {"tasks", "1", neither, "tasks the pool ran"},
    {"pool_peak", "1", lower, "tasks alive at the same time, at most"},
    {"pool_chunks", "1", neither, "work chunks run"},
    {"pool_claims", "1", lower, "claims of chunks from the shared pool"},
    {"pool_failed_claims", "1", lower, "claims that another subgroup forestalled"},
    {"pool_polls", "1", lower, "looks for work or for a free slot"},
    {"pool_growths", "1", lower, "times the pool ran out of slots and was doubled"},
    {"packet_width", "1", neither, "rays per packet"},
    {"rays", "1", neither, "rays traced"},
    {"mrays_per_s", "Mrays/s", higher, "rays per second, in millions"},
};

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

const Metric* find_metric(std::string_view name) {
    for (const Metric& metric : kMetrics)
        if (metric.name == name) return &metric;
    return nullptr;
}

}  // namespace experiments::measure
