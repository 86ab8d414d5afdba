// Step 1 of the collapse: the grid of the tree, and a first level that holds the root.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "structures/bvh/wide/build.glsl"

void main() {
    if (gl_SubgroupInvocationID != 0) return;
    const BvhNode root = push.binary.at[0];
    const bool empty = root.count == 0 && root.first == 0;
    WideHeader header;
    header.origin = empty ? vec3(0) : root.lower;
    header.upper = empty ? vec3(0) : root.upper;
    const vec3 extent = header.upper - header.origin;
    // Never 0, and finite even where the extent is not.
    header.cell = max(mix(header.upper / kGridTop - header.origin / kGridTop, extent / kGridTop,
                          lessThan(extent, vec3(1e38))),
                      vec3(1e-30));
    header.node_count = empty ? 0 : 1;
    header.pending = header.node_count;
    header.depth = 0;
    push.header.header = header;
    push.items.at[0] = WideItem(0, root.first, root.count);
    push.levels.at[0] = WideLevel(header.node_count, 1, 1, 0, header.node_count);
}
