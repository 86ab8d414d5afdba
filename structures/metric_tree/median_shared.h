// What the top-down build of metric trees (median.comp) and its host side (median.cpp) both know.
#ifndef STRUCTURES_METRIC_TREE_MEDIAN_SHARED_H
#define STRUCTURES_METRIC_TREE_MEDIAN_SHARED_H

#include "taskpool/gpu/shared_types.h"

#ifdef __cplusplus
namespace structures::metric_tree {
using namespace taskpool::gpu::shared_types;
#define MEDIAN_CONSTANT constexpr
#else
#define MEDIAN_CONSTANT const
#endif

// Phases of a task. The root begins with the first two, all others with one of kPhaseChoose and
// kPhaseLeaf.
MEDIAN_CONSTANT uint kPhaseCount = 0;      // per chunk, how many clusters are elements
MEDIAN_CONSTANT uint kPhaseGather = 1;     // writes those elements' numbers side by side
MEDIAN_CONSTANT uint kPhaseChoose = 2;     // pivot and delta, from samples
MEDIAN_CONSTANT uint kPhaseClassify = 3;   // near, far or overlapping; counts and bounds
MEDIAN_CONSTANT uint kPhasePartition = 4;  // moves them
MEDIAN_CONSTANT uint kPhaseList = 5;       // links what no pivot tells apart, one after another
MEDIAN_CONSTANT uint kPhaseLeaf = 6;       // all that is below a range of a few elements
MEDIAN_CONSTANT uint kPhaseSpawn = 7;      // no phase: the range's parts are to be built
MEDIAN_CONSTANT uint kPhaseEnd = 8;        // no phase: the range is done

/// In a chunk at least, unless it is the range's only one.
MEDIAN_CONSTANT uint kChunkElements = 256;
/// In a range that one chunk builds the subtree of, at most.
MEDIAN_CONSTANT uint kSubtreeElements = 20;
/// In a range that a subgroup holds in its lanes, at most.
MEDIAN_CONSTANT uint kMostLeafRange = 16;
/// Candidates for a pivot, no more than lanes; elements that they are judged by, and those that
/// candidates for delta are.
MEDIAN_CONSTANT uint kCandidates = 8;
MEDIAN_CONSTANT uint kPivotSample = 32;
MEDIAN_CONSTANT uint kDeltaSample = 64;
/// Distances of each kind that are tried as delta by cost.
MEDIAN_CONSTANT uint kQuantiles = 8;
/// In a range that is split even if that takes but its pivot off, at most.
MEDIAN_CONSTANT uint kChainElements = 64;
/// Pivots tried before what is left becomes a list.
MEDIAN_CONSTANT uint kTries = 2;
/// Of a chunk; see median_partition.glsl.
MEDIAN_CONSTANT uint kScratchWords = 8;

#ifdef __cplusplus
}  // namespace structures::metric_tree
#endif
#undef MEDIAN_CONSTANT
#endif
