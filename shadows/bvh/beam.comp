// Shadow query, one beam per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/bvh/query.glsl"
#include "shadows/tiles/beams.glsl"
#include "shadows/bvh/packet.glsl"
#include "shadows/bvh/walk.glsl"

void main() {
    const WideHeader header = push.structure.header.header;
    const vec3 origin = kDirectional ? 0.5 * header.origin + 0.5 * header.upper : push.light;
    const vec3 farthest = max(abs(header.upper - origin), abs(header.origin - origin));
    answer_by_beams(origin, max(max(farthest.x, farthest.y), farthest.z));
}
