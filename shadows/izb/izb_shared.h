// What C++ and the kernels of the irregular z-buffer share.
#ifndef SHADOWS_IZB_IZB_SHARED_H
#define SHADOWS_IZB_IZB_SHARED_H

#ifdef __cplusplus
#include <cstddef>

#include "taskpool/gpu/shared_types.h"

namespace shadows::izb {
using namespace taskpool::gpu::shared_types;
#define GROVE_CONSTANT inline constexpr
#else
#define GROVE_CONSTANT const
#endif

GROVE_CONSTANT uint kFaces = 6u;       // of the cube around the light: 2 axis + (1 on the low side)
GROVE_CONSTANT uint kLevels = 12u;     // of a face's pyramid: 2048 cells a side at most
GROVE_CONSTANT uint kTileLog = 3u;     // tiles of 8 x 8 cells: level 3 of the pyramid
GROVE_CONSTANT uint kRowCells = 256u;  // cells a side of the longest entry
GROVE_CONSTANT uint kRangePoints = 2048u;  // points of one cell tested in one go

// One face's grid: 2^log_width x 2^log_height cells, row by row, over the rectangle of u and v that
// its points fill. Nothing but `points` is set where there are none.
struct IzbFace {
    vec2 lower;
    vec2 upper;
    vec2 cells_per_unit;
    vec2 cell;    // size
    vec2 pad;     // rounding: a cell's points lie within its rectangle widened by this
    float reach;  // largest 1-norm of a point's coordinates in the frame
    uint points;
    uint log_width;
    uint log_height;
    uint level_first[kLevels];  // first node of each level; those of level 0 are the cells
};

// The frame of a query; see frame.glsl.
struct IzbFrame {
    vec3 origin;
    float scale;
    vec2 tilt;  // directional light: t.x / t.z and t.y / t.z, t towards the light
    uint face;  // directional light: the only face
    IzbFace faces[kFaces];
};

// Extent of the points of one face, floats as ordered words (ordered.glsl), of which
// the lower ones are stored complemented: all grow from 0.
struct IzbExtent {
    uint not_lower_u, not_lower_v, upper_u, upper_v, reach, points;
};

struct IzbExtents {
    IzbExtent faces[kFaces];
    uint unplaced;  // points of no face, as their place overflows: they get no answer
};

// A point in its cell: u, v, k (see frame.glsl), and its primitive, or kNoPrimitive once it is known
// to be shadowed.
struct IzbPoint {
    float u, v, k;
    uint primitive;
};

GROVE_CONSTANT uint kFaceShift = 29u, kCasterMask = (1u << kFaceShift) - 1u;
// A triangle and cells that may hold points it occludes.
struct IzbEntry {
    uint caster;  // triangle | face << kFaceShift
    uint lower;   // first cell: x | y << 16
    uint upper;   // last cell
    float reach;  // largest 1-norm of the cells' points
};

// Points of one cell left to be tested against an entry's triangle.
struct IzbRange {
    uint entry;
    uint begin;
    uint end;
};

// The lists of a pass: entries, ranges, and pairs of an entry and a point for occludes_exactly().
GROVE_CONSTANT uint kLists = 3u, kEntries = 0u, kRanges = 1u, kUnsurePairs = 2u;

struct IzbStatus {
    uint counts[kLists];  // more than the capacity: some did not fit, repeat the pass
    uint next_entry;
    uint next_range;
    // With statistics, as 64-bit counts, low word first: points against the functions of a
    // triangle, and of these, points left to the exact test.
    uvec2 tests;
    uvec2 exact_tests;
    uvec3 groups[kLists];  // arguments of the dispatch over each list
};

#ifdef __cplusplus
static_assert(sizeof(IzbFace) == 104);
static_assert(sizeof(IzbFrame) == 28 + kFaces * sizeof(IzbFace));
static_assert(sizeof(IzbExtents) == kFaces * 24 + 4);
static_assert(sizeof(IzbPoint) == 16);
static_assert(sizeof(IzbEntry) == 16 && sizeof(IzbRange) == 12);
static_assert(sizeof(IzbStatus) == 72 && offsetof(IzbStatus, groups) == 36);
}  // namespace shadows::izb
#endif
#undef GROVE_CONSTANT
#endif
