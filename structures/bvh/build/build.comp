// Top-down BVH build on the task pool: binned SAH or spatial median, then full SAH over ranges that
// fit a subgroup (Vinkler, Bittner and Havran 2013, section 4.1).
//
// Departures from the paper: bins divide the bounds of the primitives' centres; children
// are numbered by where their range is split, so nodes need no atomic counter; where a primitive
// lands depends on nothing but the input. Equal inputs give equal trees, bit for bit, whatever the
// number of subgroups and the policy; and on every device if kLeafRange is the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"
#include "structures/bvh/build/build_shared.h"
#include "structures/bvh/bvh_shared.h"
#include "structures/bvh/build/keys.glsl"

/// Ranges of at most this many primitives go to full SAH; at most the subgroup size.
layout(constant_id = 22) const uint kLeafRange = 8;
layout(constant_id = 23) const bool kSpatialMedian = false;
layout(constant_id = 24) const uint kMaxDepth = 64;

const uint kRuleHalve = 0;  // the first half goes left
const uint kRuleMiddle = 1;  // centres up to `middle` on `axis` go left
const uint kRuleBins = 2;    // bins up to `cut` of `axis` go left

struct Task {
    uint first, count;
    uint node, depth;
    uint side;  // which primitives hold the range
    KeyBox box;
    vec3 center_lower, center_upper;  // bounds of lower + upper of the primitives' boxes
    uint rule, axis;
    float middle;
    uint cut;
    bool looks;  // for the best split between bins; otherwise the rule is set
    uint axes;  // a bit for each that is looked at
    vec3 bin_scale, bin_offset;
    uint left_count;
    KeyBox left_box, left_centers, right_box, right_centers;
};

pool_buffer(4) Primitives { Primitive at[]; };
pool_buffer(4) Nodes { BvhNode at[]; };
pool_buffer(4) Scratch { uint words[]; };
pool_buffer(8) Input { BuildInput data; };

struct Client {
    Primitives primitives[2];  // sorted from one into the other
    PoolUints order;           // output: their triangles in leaf order
    Nodes nodes;
    Scratch scratch;  // see scratch.glsl
    Input mesh;
};

#include "taskpool/pool/pool.glsl"

float component(vec3 v, uint axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
uint component(uvec3 v, uint axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Primitives primitives_of(uint side) {
    return Primitives(side == 0 ? uint64_t(pool.client.primitives[0])
                                : uint64_t(pool.client.primitives[1]));
}

#include "structures/bvh/build/ranges.glsl"
#include "structures/bvh/build/bins.glsl"
#include "structures/bvh/build/scratch.glsl"
#include "structures/bvh/build/setup.glsl"
#include "structures/bvh/build/leaves.glsl"
#include "structures/bvh/build/partition.glsl"
#include "structures/bvh/build/transitions.glsl"

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    const uint begin = task.first + chunk * kChunkPrimitives;
    const uint end = min(begin + kChunkPrimitives, task.first + task.count);
    switch (phase) {
        case kPhaseSetup: setup_chunk(begin, end); break;
        case kPhaseCompact: compact_chunk(begin, end); break;
        case kPhaseCount: count_chunk(task, begin, end); break;
        default:
            if (phase == kPhaseSubtree) pool_progress(task.count);
            split_chunk(task, phase, step, begin, end);
    }
}

Next finish_step(inout Task task, uint phase, uint step) {
    switch (phase) {
        case kPhaseSetup: return after_setup(task);
        case kPhaseCompact: return after_compact(task);
        case kPhaseBins: return after_bins(task, step);
        case kPhaseCount: return after_count(task, step);
        case kPhasePartition: return after_partition(task);
        case kPhaseSmall: return split_task(task);
    }
    return next_end();
}

Task spawn_child(Task parent, uint child, out Start start) {
    const Task task = child_of(parent, child);
    const Next first = first_step(task);
    start = Start(first.phase, first.step, first.chunks, 0);
    return task;
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
