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
// the true one, and still does for those who ask which segments meet it, from points no farther
// than `reach` from `from`. With e = 2^-24 and R = |origin| + |from| + 65,535 cell + reach,
// decoding rounds four times, each by at most e R. A slab test (t = bits * (cell / d) + base / d)
// has 6 e R from the reciprocal of a rounded difference and six more roundings; a beam compares x
// with slope * z and adds three, the rounding of its slopes being in the slopes. So 12 e R is all
// that is needed, as what is decided about triangles is exact. 2^-19 R, which is 32 e R, is more
// than twice that.
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
