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
KeyBox keep_if(bool yes, KeyBox box) {
    return KeyBox(mix(uvec3(0), box.low, bvec3(yes)), mix(uvec3(0), box.high, bvec3(yes)));
}
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

// ---- Over the subgroup, through shared memory: cheaper than a chain of subgroup reductions ---------

const uint kMaxRows = 24;
shared uint reduce_rows[kMaxRows * 64];  // row-major; subgroups have at most 64 lanes

void store_row(uint row, uint key) { reduce_rows[row * gl_SubgroupSize + gl_SubgroupInvocationID] = key; }
void store_rows(uint first, KeyBox box) {
    for (uint k = 0; k < 3; ++k) {
        store_row(first + k, box.low[k]);
        store_row(first + 3 + k, box.high[k]);
    }
}
/// Leaves each row's maximum in reduce_rows[row].
void max_rows(uint rows) {
    subgroup_sync();
    for (uint begin = 0; begin < rows; begin += gl_SubgroupSize) {
        const uint row = begin + gl_SubgroupInvocationID;
        uint best = 0;
        if (row < rows)
            for (uint lane = 0; lane < gl_SubgroupSize; ++lane)
                best = max(best, reduce_rows[row * gl_SubgroupSize + lane]);
        subgroup_sync();
        if (row < rows) reduce_rows[row] = best;
        subgroup_sync();
    }
}
KeyBox reduced(uint first) {
    return KeyBox(uvec3(reduce_rows[first], reduce_rows[first + 1], reduce_rows[first + 2]),
                  uvec3(reduce_rows[first + 3], reduce_rows[first + 4], reduce_rows[first + 5]));
}
