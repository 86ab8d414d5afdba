// Binned SAH: bins in shared memory, and the best plane among all bin borders of all three axes.
//
// Each column of lanes has bins of its own, so that on a device without fast shared atomics every
// lane has one and none are needed. A bin is seven words: a box as keys, and a count; all grow from 0.

layout(constant_id = 16) const uint kBins = 12;     // per axis
layout(constant_id = 17) const uint kColumns = 1;   // = subgroup size: no atomics
const uint kBinWords = kKeys + 1;
const uint kAllBinWords = 3 * kBins * kBinWords;

shared uint bin_columns[kAllBinWords * kColumns];
shared uint bins[kAllBinWords];

void clear_bins() {
    for (uint i = gl_SubgroupInvocationID; i < kAllBinWords * kColumns; i += gl_SubgroupSize)
        bin_columns[i] = 0;
    subgroup_sync();
}

/// kBins / extent with the 23 bits that every device agrees on: integer division is exact everywhere,
/// division of floats is not. 0 for an extent without room for planes.
float exact_scale(float extent) {
    const uint bits = floatBitsToUint(extent);
    const int exponent = int(bits >> 23) - 127;
    if (exponent < -100) return 0.0;
    const uint64_t mantissa = uint64_t((bits & 0x7fffffu) | 0x800000u);
    const uint64_t quotient = (uint64_t(kBins) << 43) / mantissa;  // below 2^32 for up to 2047 bins
    // float(uint) may round: keep the 24 leading bits.
    const int excess = max(findMSB(uint(quotient)) - 23, 0);
    const float exact = float((uint(quotient) >> excess) << excess);
    return exact * uintBitsToFloat(uint(127 - 20 - exponent) << 23);
}
vec3 bin_scale(vec3 lower, vec3 upper) {
    precise vec3 extent = upper - lower;
    return vec3(exact_scale(extent.x), exact_scale(extent.y), exact_scale(extent.z));
}

/// `center` is a box's lower + upper, as are the bounds that `lower` comes from.
uvec3 bin_of(vec3 center, vec3 lower, vec3 scale) {
    precise vec3 place = (center - lower) * scale;
    return min(uvec3(place), uvec3(kBins - 1));
}

void add_to_bin(uint axis, uint bin, KeyBox box) {
    const uint column = gl_SubgroupInvocationID % kColumns;
    const uint at = (axis * kBins + bin) * kBinWords * kColumns + column;
    if (kColumns == gl_SubgroupSize) {
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            const uint low = at + k * kColumns, high = at + (3 + k) * kColumns;
            bin_columns[low] = max(bin_columns[low], box.low[k]);
            bin_columns[high] = max(bin_columns[high], box.high[k]);
        }
        bin_columns[at + kKeys * kColumns] += 1;
    } else {
        [[unroll]] for (uint k = 0; k < 3; ++k) {
            atomicMax(bin_columns[at + k * kColumns], box.low[k]);
            atomicMax(bin_columns[at + (3 + k) * kColumns], box.high[k]);
        }
        atomicAdd(bin_columns[at + kKeys * kColumns], 1u);
    }
}

/// bins[] = the columns taken together.
void merge_columns() {
    subgroup_sync();
    for (uint word = gl_SubgroupInvocationID; word < kAllBinWords; word += gl_SubgroupSize) {
        uint most = 0, sum = 0;
        for (uint column = 0; column < kColumns; ++column) {
            const uint value = bin_columns[word * kColumns + column];
            most = max(most, value);
            sum += value;
        }
        bins[word] = word % kBinWords == kKeys ? sum : most;
    }
    subgroup_sync();
}

// ---- Choosing a plane -----------------------------------------------------------------------------

shared float side_cost[2 * 3 * kBins];

KeyBox bin_box(uint word) {
    return KeyBox(uvec3(bins[word], bins[word + 1], bins[word + 2]),
                  uvec3(bins[word + 3], bins[word + 4], bins[word + 5]));
}

/// The plane (axis * kBins + last bin on the left) of least area * count summed over both sides, or
/// kNoPlane if none separates anything. Equal costs: the lowest plane.
const uint kNoPlane = 0xffffffffu;
const float kInfinity = 1.0 / 0.0;

uint best_plane() {
    // Six sweeps, a lane each: area * count of bins [0, b] and of bins [b, kBins), per axis.
    for (uint sweep = gl_SubgroupInvocationID; sweep < 6; sweep += gl_SubgroupSize) {
        const uint axis = sweep % 3;
        KeyBox box = empty_keys();
        uint count = 0;
        for (uint i = 0; i < kBins; ++i) {
            const uint bin = sweep < 3 ? i : kBins - 1 - i;
            const uint word = (axis * kBins + bin) * kBinWords;
            box = join(box, bin_box(word));
            count += bins[word + kKeys];
            precise float cost = half_area(box) * float(count);
            side_cost[sweep * kBins + bin] = count == 0 ? kInfinity : cost;
        }
    }
    subgroup_sync();
    float best = kInfinity;
    uint plane = kNoPlane;
    for (uint p = gl_SubgroupInvocationID; p < 3 * kBins; p += gl_SubgroupSize) {
        const uint axis = p / kBins;
        if (p % kBins == kBins - 1) continue;
        precise float cost = side_cost[p] + side_cost[(3 + axis) * kBins + p % kBins + 1];
        if (cost < best) {
            best = cost;
            plane = p;
        }
    }
    const float least = subgroupMin(best);
    if (least == kInfinity) return kNoPlane;
    return subgroupMin(best == least ? plane : kNoPlane);
}
