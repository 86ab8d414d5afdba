// What the kernels of the collapse share: their push constants and how a level is cut into chunks.
#include "taskpool/gpu/device.glsl"
#include "taskpool/gpu/shared_types.h"
#include "structures/bvh/bvh_shared.h"
#include "structures/bvh/wide/wide_shared.h"
layout(local_size_x_id = 0) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinaryNodes { BvhNode at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer WideNodes { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Header { WideHeader header; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Items { WideItem at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Levels { WideLevel at[]; };

layout(push_constant, scalar) uniform Push {
    BinaryNodes binary;
    WideNodes nodes;
    Header header;
    Items items;
    Levels levels;
    UintArray chunk_offsets;  // inner children per chunk; then the first node of each chunk's
    uint level;
} push;

// A child while its node is being put together: node, first, count, kind.
const uint kKindInner = 0u, kKindLeaf = 1u, kKindEmpty = 2u;

// Dispatches are at most this wide; workgroups stride over the chunks.
const uint kMaxGroups = 32768u;
