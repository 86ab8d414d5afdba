// What the kernels of the BVH shadow query share: the tree, and where segments begin.
#include "taskpool/gpu/device.glsl"
#include "structures/bvh/wide/wide_node.glsl"
layout(constant_id = 1) const bool kDirectional = false;

struct Structure {
    WideHeaderRef header;
    WideChildren nodes;
    CornerTriangles triangles;
};
#include "shadows/tiles/tiles.glsl"

layout(constant_id = 22) const float kBias = 0.0;  // how far points move towards the light: a
                                                   // fraction of the way, or of the scene's diagonal

vec3 asked_from(vec3 p) {
    if (kBias == 0.0) return p;
    if (!kDirectional) return p + kBias * (push.light - p);
    const WideHeader header = push.structure.header.header;
    return p + kBias * length(header.upper - header.origin) * normalize(push.light);
}
