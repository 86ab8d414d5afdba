// Radix sort, second half of a pass: each block moves its keys to their places, in order.
//
// Lanes with equal digits find each other by one ballot per bit; the lowest takes a run of places
// for all of them, so equal keys keep their order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/gpu/device.glsl"

#include "taskpool/primitives/primitives_shared.h"
#include "taskpool/primitives/quad.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kKeyWords = 1;
layout(push_constant, scalar) uniform Block { SortPush push; };

const uint kDigits = 256, kDigitBits = 8;
shared uint places[kDigits];

void main() {
    for (uint digit = gl_SubgroupInvocationID; digit < kDigits; digit += gl_SubgroupSize)
        places[digit] = UintArray(push.histogram).at[digit * push.block_count + gl_WorkGroupID.x];
    barrier();
    UintArray keys = UintArray(push.keys), sorted_keys = UintArray(push.sorted_keys);
    uint begin = gl_WorkGroupID.x * push.block_length;
    uint end = block_end(gl_WorkGroupID.x, push.block_length, push.count);
    for (uint step = begin; step < end; step += gl_SubgroupSize) {
        uint i = step + gl_SubgroupInvocationID;
        bool valid = i < end;
        uint digit = valid ? keys.at[i * kKeyWords + push.word] >> push.shift & push.mask : 0;
        uvec4 peers = subgroupBallot(valid);
        [[unroll]] for (uint bit = 0; bit < kDigitBits; ++bit) {
            bool set = (digit >> bit & 1u) != 0;
            uvec4 ones = subgroupBallot(set);
            peers &= set ? ones : ~ones;
        }
        uint rank = subgroupBallotExclusiveBitCount(peers);
        uint leader = valid ? subgroupBallotFindLSB(peers) : gl_SubgroupInvocationID;
        uint place = 0;
        // The shuffle needs the atomic's result: no lane comes to the next atomic before it.
        if (valid && leader == gl_SubgroupInvocationID)
            place = atomicAdd(places[digit], subgroupBallotBitCount(peers), gl_ScopeWorkgroup,
                              gl_StorageSemanticsNone, gl_SemanticsRelaxed);
        place = subgroupShuffle(place, leader) + rank;
        if (valid) {
            [[unroll]] for (uint word = 0; word < kKeyWords; ++word)
                sorted_keys.at[place * kKeyWords + word] = keys.at[i * kKeyWords + word];
            UintArray(push.sorted_values).at[place] = UintArray(push.values).at[i];
        }
    }
}
