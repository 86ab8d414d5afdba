// Is the map's nearest caster, in the texel that a point falls into, nearer to the light than the
// point is? One tap per point. Williams 1978, "Casting curved shadows on curved surfaces".
//
// Bias. A texel holds the depth at its centre. The stored depth is moved away from the light, by
// the rasteriser or here; with kReceiverPlane the point's depth is taken where the texel's centre
// meets the plane of the point's triangle: Isidoro 2006, "Shadow mapping: GPU-based tips and
// techniques". The plane is the triangle's own, not one estimated from neighbours on the screen.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "shadows/beam/points.glsl"
#include "shadows/shadow_map/view.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 2) const bool kReceiverPlane = false;
layout(push_constant, scalar) uniform Block { LookupPush push; };

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Views { View at[]; };

const uint kNoReceiver = 0xfffffffeu;
// The rasteriser places corners on a grid of 1/256 texel or finer: this part of the change of depth
// over a texel is no more certain than that.
const float kSnap = 1.0 / 64.0;

// Each lane's own view, from those all lanes have.
View select_view(View views[kFaces], uint face) {
    View chosen = views[0];
    if (kDirectional) return chosen;
    [[unroll]] for (uint f = 1; f < kFaces; ++f) {
        if (face == f) chosen = views[f];
    }
    return chosen;
}

// Depth of the plane through q with this normal, `offset` (as of on_plane) away from q.
float depth_on_plane(View view, vec3 q, vec3 normal, vec2 offset) {
    const float change = kDirectional ? view.per_depth / normal.z : view.near / dot(normal, q);
    const float depth = depth_at(view, q.z);
    if (isinf(change) || isnan(change)) return depth;  // seen edge on
    const vec2 texel = 2.0 / (view.scale * push.resolution);
    return depth + change * dot(normal.xy, offset) +
           kSnap * abs(change) * dot(abs(normal.xy), texel);
}

// Zero for a triangle without area: such a receiver has no plane.
vec3 normal_of(uint primitive, uint face) {
    return view_coordinates(push.frame, face, Vec3Array(push.normals).at[primitive]);
}

bool shadowed(vec3 p, uint primitive, View views[kFaces]) {
    const vec3 r = p - push.frame.origin;
    const uint face = face_towards(r);
    const View view = select_view(views, face);
    const vec3 q = view_coordinates(push.frame, face, r);
    const vec2 s = on_plane(q);
    const vec2 place = view.scale * s + view.offset;
    if (!all(lessThanEqual(abs(place), vec2(1)))) return false;  // no caster there; or at the light
    const uvec2 texel =
        min(uvec2((place * 0.5 + 0.5) * push.resolution), uvec2(push.resolution - 1));
    const uint64_t map = push.maps + 4ul * push.resolution * push.resolution * view.slot;
    const float stored = FloatArray(map).at[texel.y * push.resolution + texel.x];

    float depth = depth_at(view, q.z);
    if (kReceiverPlane && primitive < kNoReceiver) {
        const vec2 centre = (vec2(texel) + 0.5) * (2.0 / push.resolution) - 1.0;
        depth = depth_on_plane(view, q, normal_of(primitive, face), (centre - place) / view.scale);
    }
    // Where nothing was drawn, 0 is stored, which no depth is below.
    const float moved = kDirectional ? stored - view.bias : stored * (1.0 - view.bias);
    return moved > max(depth, 0);
}

void main() {
    const uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (tile >= push.point_count / kTilePoints) return;
    View views[kFaces];
    [[unroll]] for (uint f = 0; f < kFaces; ++f) views[f] = Views(push.views).at[f];
    FloatArray points = FloatArray(push.points);
    uint dark = 0;
    for (uint k = 0; k < kSlots; ++k) {
        const uint i = tile_point(tile, k);
        const vec3 p = vec3(points.at[i], points.at[push.point_count + i],
                            points.at[2 * push.point_count + i]);
        const uint primitive = floatBitsToUint(points.at[3 * push.point_count + i]);
        if (primitive != kNoPrimitive && shadowed(p, primitive, views)) dark |= 1u << k;
    }
    store_tile(UintArray(push.visible), tile, ~dark);
}
