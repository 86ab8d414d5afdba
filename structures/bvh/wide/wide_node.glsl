// Reading wide BVH nodes in a shader; see wide_shared.h.
#ifndef STRUCTURES_BVH_WIDE_WIDE_NODE_GLSL
#define STRUCTURES_BVH_WIDE_WIDE_NODE_GLSL
#include "taskpool/gpu/shared_types.h"
#include "structures/bvh/wide/wide_shared.h"
#include "structures/geometry/corner_triangles.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer WideChildren {
    uvec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer WideHeaderRef {
    WideHeader header;
};

bool is_leaf(uint link) { return (link & kLeafBit) != 0; }
uint leaf_first(uint link) { return link & kLeafFirstMask; }
uint leaf_count(uint link) { return (link & ~kLeafBit) >> kLeafCountShift; }

// The grid seen from another origin, ready to decode: lower = base_lower + cell * (bits & 0xffff),
// upper = base_upper + cell * (bits >> 16). The bases are widened so that the decoded box contains
// the true one as the exact test sees it, from points at most `reach` away from `from`. With
// R = |origin| + |from| + 65,535 cell + reach, decoding rounds three times, each by at most 2^-24 R;
// the exact test sees corners off by at most 11 * 2^-24 R (candidate.glsl). 2^-19 R is twice that.
struct Grid {
    vec3 base_lower;
    vec3 base_upper;
    vec3 cell;
};

Grid grid_from(WideHeader header, vec3 from, float reach) {
    const vec3 slack =
        (abs(header.origin) + abs(from) + 65535.0 * header.cell + reach) * 1.9073486328125e-6;
    return Grid(header.origin - from - slack, header.origin - from + slack, header.cell);
}

#endif
