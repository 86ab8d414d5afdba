// Boxes as six integer keys that all grow by max(): a box starts at all zeros, atomics on floats are
// not needed, and the result does not depend on any order.

/// Integers that order like the floats they stand for; 0 is below every finite float's.
uvec3 ordered(vec3 v) {
    const uvec3 bits = floatBitsToUint(v);
    return bits ^ mix(uvec3(0x80000000u), uvec3(0xffffffffu), notEqual(bits & 0x80000000u, uvec3(0)));
}
vec3 from_ordered(uvec3 key) {
    return uintBitsToFloat(key ^ mix(uvec3(0xffffffffu), uvec3(0x80000000u),
                                     notEqual(key & 0x80000000u, uvec3(0))));
}

/// The box covered by `low` and `high`, the latter two being complemented lower corners' keys and
/// upper corners' keys.
struct KeyBox {
    uvec3 low, high;
};
KeyBox empty_keys() { return KeyBox(uvec3(0), uvec3(0)); }
KeyBox keys_of(vec3 lower, vec3 upper) { return KeyBox(~ordered(lower), ordered(upper)); }
KeyBox join(KeyBox a, KeyBox b) { return KeyBox(max(a.low, b.low), max(a.high, b.high)); }
vec3 lower_of(KeyBox box) { return from_ordered(~box.low); }
vec3 upper_of(KeyBox box) { return from_ordered(box.high); }
bool is_empty(KeyBox box) { return box.high.x == 0; }

/// Half the surface area; 0 for an empty box. `precise`: the same on every device.
float half_area(vec3 lower, vec3 upper) {
    precise vec3 e = upper - lower;
    precise float area = (e.x * e.y + e.y * e.z) + e.z * e.x;
    return area;
}
float half_area(KeyBox box) { return is_empty(box) ? 0.0 : half_area(lower_of(box), upper_of(box)); }

/// The box if every bit of `mask` is set; the empty box if none is.
KeyBox masked(uint mask, KeyBox box) { return KeyBox(box.low & mask, box.high & mask); }

/// Joins `box` into the other one, if it is to; one instruction a key where that is a masked max().
void take_in(inout KeyBox into, KeyBox box, bool taken) {
    [[unroll]] for (uint k = 0; k < 3; ++k) {
        into.low[k] = taken ? max(into.low[k], box.low[k]) : into.low[k];
        into.high[k] = taken ? max(into.high[k], box.high[k]) : into.high[k];
    }
}

KeyBox[4] no_boxes() {
    return KeyBox[](empty_keys(), empty_keys(), empty_keys(), empty_keys());
}
const uint kReduceIterations = 8;  // of join_lanes() at most

/// Joins the boxes of all lanes, for all lanes.
void join_lanes(inout KeyBox boxes[4]) {
    for (uint apart = gl_SubgroupSize / 2; apart > 0; apart /= 2) {
        [[unroll]] for (uint k = 0; k < 4; ++k)
            boxes[k] = join(boxes[k], KeyBox(subgroupShuffleXor(boxes[k].low, apart),
                                             subgroupShuffleXor(boxes[k].high, apart)));
    }
}
