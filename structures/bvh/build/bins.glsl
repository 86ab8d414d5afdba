// SAH over bins: primitives are counted, and their boxes joined, in kBins bins of their centres on each
// axis, and a split between any two bins is a candidate. A lane owns a few bins, in registers, and all
// primitives pass by (paper, section 4.1, has a thread per plane; a bin takes in a box once, where a
// plane takes it in on either side).
//
// Measured on lavapipe: bins in shared memory, two accesses per word and primitive, were far slower.

layout(constant_id = 25) const uint kLanes = 8;      // in a subgroup
layout(constant_id = 16) const uint kAxisLanes = 8;  // lanes that hold one axis' bins
const uint kAxisLaneBits = 3;                        // kAxisLanes <= 8
#include "taskpool/primitives/lanes.glsl"
const uint kSlots = kBins / kAxisLanes;              // bins of an axis per lane
layout(constant_id = 17) const uint kSets = 3;       // axes per lane: 3 kAxisLanes / subgroup size, up
const uint kRows = kSets * kSlots;
const uint kBinWords = kKeys + 1;
const uint kNone = 0xffffffffu;
const float kAxisMargin = 1.05;  // by how much a closer look may better a split
const float kInfinity = 1.0 / 0.0;

struct Bin {
    KeyBox box;
    uint count;
};

/// Lane's axis in set `set` of its bins; 3 or more: none.
uint axis_of(uint set) {
    return set * (kLanes / kAxisLanes) + gl_SubgroupInvocationID / kAxisLanes;
}
uint axis_lane() { return gl_SubgroupInvocationID % kAxisLanes; }
/// Lane's bin in a row, among those of all axes.
uint bin_of_row(uint row) {
    return axis_of(row / kSlots) * kBins + axis_lane() * kSlots + row % kSlots;
}

/// The bin of a centre. Never evaluated otherwise: looks and partitions have to agree. The sum's last
/// bits are the bin, as conversions to integers cost lavapipe ten times as much.
uint bin_of(float center, float origin, float scale, float offset) {
    precise float place = (center - origin) * scale + offset;
    const float magic = 8388607.5;  // 2^23 - 1/2
    precise float rounded = clamp(place, 0.5, float(kBins) - 0.5) + magic;
    return floatBitsToUint(rounded) & (kBins - 1);
}
uint bin_of(Task task, vec3 center, uint axis) {
    return bin_of(component(center, axis), component(task.center_lower, axis),
                  component(task.bin_scale, axis), component(task.bin_offset, axis));
}

void clear_bins(out Bin bins[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row) bins[row] = Bin(empty_keys(), 0);
}

/// Passes the primitives of [begin, end) by the bins of the task's axes.
void pass_primitives(Task task, uint begin, uint end, inout Bin bins[kRows]) {
    uint mask[kSets], pattern[kSets];  // what a primitive's word of bins shows to this lane
    bool wanted[kSets];
    [[unroll]] for (uint set = 0; set < kSets; ++set) {
        const uint shift = 8 * min(axis_of(set), 3u);
        mask[set] = 0xffu << shift;
        wanted[set] = (task.axes >> axis_of(set) & 1) != 0;
        pattern[set] = (axis_of(set) < 3 ? axis_lane() * kSlots : 0xffu) << shift;
    }
    Primitives primitives = primitives_of(task.side);
    Primitive next = primitives.at[min(begin + gl_SubgroupInvocationID, end - 1)];
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = next;
        next = primitives.at[min(mine + gl_SubgroupSize, end - 1)];
        precise vec3 center = primitive.lower + primitive.upper;
        const KeyBox box = keys_of(primitive.lower, primitive.upper);
        const uint word = mine < end ? bin_of(task, center, 0) | bin_of(task, center, 1) << 8 |
                                           bin_of(task, center, 2) << 16
                                     : 0x7fffffffu;
        [[unroll]] for (uint first = 0; first < kLanes; first += kAxisLanes) {
            uint passing[kAxisLanes];
            KeyBox passing_box[kAxisLanes];
            [[unroll]] for (uint k = 0; k < kAxisLanes; ++k) {
                passing[k] = subgroupShuffle(word, first + k);
                passing_box[k] = KeyBox(subgroupShuffle(box.low, first + k),
                                        subgroupShuffle(box.high, first + k));
            }
            [[unroll]] for (uint set = 0; set < kSets; ++set) {
                if (wanted[set]) {
                    [[unroll]] for (uint slot = 0; slot < kSlots; ++slot) {
                        const uint bin = pattern[set] + (slot << 8 * min(axis_of(set), 3u));
                        Bin taking = bins[set * kSlots + slot];
                        [[unroll]] for (uint k = 0; k < kAxisLanes; ++k) {
                            const bool taken = (passing[k] & mask[set]) == bin;
                            take_in(taking.box, passing_box[k], taken);
                            taking.count += taken ? 1 : 0;
                        }
                        bins[set * kSlots + slot] = taking;
                    }
                }
            }
        }
        pool_spend(kLanes / kAxisLanes + 2);
    }
}

Bin join(Bin a, Bin b) { return Bin(join(a.box, b.box), a.count + b.count); }
Bin bin_from(uint lane, Bin bin) {
    return Bin(box_from(lane, bin.box), subgroupShuffle(bin.count, lane));
}
Bin masked(uint mask, Bin bin) { return Bin(masked(mask, bin.box), bin.count & mask); }

/// Joined: what the axis' lanes before this one hold (`down` false: those after it).
Bin scan_lanes(Bin mine, bool down) {
    const uint lane = gl_SubgroupInvocationID, at = axis_lane();
    const uint before = down ? at : kAxisLanes - 1 - at;
    Bin sum = masked(before > 0 ? 0xffffffffu : 0, bin_from(down ? lane - 1 : lane + 1, mine));
    [[unroll]] for (uint k = 0; k < kAxisLaneBits; ++k) {
        // The first lane of the axis holds nothing: joining it again changes nothing.
        const uint hop = min(before, 1u << k);
        if (1u << k < kAxisLanes) sum = join(sum, bin_from(down ? lane - hop : lane + hop, sum));
    }
    return sum;
}

/// Of the best split between bins on each of `axes`: its cost (area * count over both sides), infinite if
/// there is none, and the last bin on its left.
void best_splits(uint axes, Bin bins[kRows], out vec3 cost, out uvec3 cut) {
    cost = vec3(kInfinity);
    cut = uvec3(kNone);
    [[unroll]] for (uint set = 0; set < kSets; ++set) {
        // An axis that nobody looks at has empty bins.
        if ((axes >> set * (kLanes / kAxisLanes) & (1u << kLanes / kAxisLanes) - 1) != 0) {
            Bin own = bins[set * kSlots];
            [[unroll]] for (uint slot = 1; slot < kSlots; ++slot) own = join(own, bins[set * kSlots + slot]);
            Bin left = scan_lanes(own, true);
            const Bin after = scan_lanes(own, false);
            float best = kInfinity;
            uint best_bin = kNone;
            [[unroll]] for (uint slot = 0; slot < kSlots; ++slot) {
                left = join(left, bins[set * kSlots + slot]);
                Bin right = after;
                [[unroll]] for (uint other = slot + 1; other < kSlots; ++other)
                    right = join(right, bins[set * kSlots + other]);
                precise float mine = half_area(left.box) * float(left.count) +
                                     half_area(right.box) * float(right.count);
                if (left.count > 0 && right.count > 0 && mine < best) {
                    best = mine;
                    best_bin = axis_lane() * kSlots + slot;
                }
            }
            [[unroll]] for (uint k = 0; k < kAxisLaneBits; ++k) {
                const uint apart = kAxisLanes >> k + 1;
                if (apart > 0) {
                    const float other = subgroupShuffleXor(best, apart);
                    const uint bin = subgroupShuffleXor(best_bin, apart);
                    const bool take = other < best || (other == best && bin < best_bin);
                    best = take ? other : best;
                    best_bin = take ? bin : best_bin;
                }
            }
            const uint groups = kLanes / kAxisLanes;
            [[unroll]] for (uint axis = 0; axis < 3; ++axis) {
                const uint lane = axis % groups * kAxisLanes;
                const float axis_best = subgroupShuffle(best, lane);
                const uint axis_bin = subgroupShuffle(best_bin, lane);
                if (axis / groups == set) {
                    cost[axis] = axis_best;
                    cut[axis] = axis_bin;
                }
            }
        }
    }
}

/// Sets the task's split to the cheapest of the bins'. Unless this is the last look, the next one's bins
/// are set: all but the outermost two share out what the two bins beside each axis' best split cover;
/// axes that are too expensive to catch up are left out.
void choose_split(inout Task task, Bin bins[kRows], bool last) {
    vec3 cost;
    uvec3 cut;
    best_splits(task.axes, bins, cost, cut);
    if (last) {
        task.axis = cost.x <= cost.y && cost.x <= cost.z ? 0 : cost.y <= cost.z ? 1 : 2;
        task.cut = component(cut, task.axis);
        if (task.cut != kNone) task.rule = kRuleBins;
        return;
    }
    const float worth = kAxisMargin * min(min(cost.x, cost.y), cost.z);
    task.axes = (cost.x <= worth ? 1 : 0) | (cost.y <= worth ? 2 : 0) | (cost.z <= worth ? 4 : 0);
    const float finer = float(kBins / 2 - 1);
    precise vec3 offset = finer * (task.bin_offset - vec3(cut)) + 1.0;
    const bvec3 refined = notEqual(cut, uvec3(kNone));
    task.bin_offset = mix(task.bin_offset, offset, refined);
    task.bin_scale = mix(task.bin_scale, task.bin_scale * finer, refined);
}
