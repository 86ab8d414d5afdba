// From the points in the order of cells to one bit per point: job.zw is the address of the answer.
// One tile of 256 points per workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const uint tile = workgroup();
    if (tile >= push.point_count / kTilePoints) return;
    uint lit = 0;
    [[unroll]] for (uint k = 0; k < kSlots; ++k) {
        const uint place = push.places.at[tile_point(tile, k)];
        bool shadowed = false;
        if (place != kNoCell) shadowed = push.binned.at[place].primitive == kNoPrimitive;
        lit |= shadowed ? 0u : 1u << k;
    }
    store_tile(UintArray(packUint2x32(push.job.zw)), tile, lit);
}
