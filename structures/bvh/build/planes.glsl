// SAH over candidate planes: each lane owns kRows planes and keeps, in registers, the boxes of what
// lies on either side; primitives pass by, four per iteration (paper, section 4.1: a thread per plane).
//
// Measured on lavapipe: bins in shared memory, two accesses per word and primitive, were five times
// slower than this, although this does work for every pair of primitive and plane.

layout(constant_id = 16) const uint kPlanes = 32;  // over the three axes
layout(constant_id = 17) const uint kRows = 4;     // planes per lane: kPlanes / subgroup size, up
const uint kPlaneWords = 2 * kKeys + 1;            // keys of the left and the right box, left count
const uint kNoPlane = 0xffffffffu;
const float kInfinity = 1.0 / 0.0;

/// One lane's view of one of its planes: what goes left has a centre <= position.
struct Plane {
    uint axis;
    float position;
    KeyBox left, right;
    uint left_count;
};

/// (numerator / denominator), rounded to a float that is the same on every device.
float fraction(uint numerator, uint denominator) {
    return float(65536 * numerator / denominator) / 65536.0;
}

/// Plane `id` of kPlanes of a look. The first look's are evenly spaced inside the centres' bounds; the
/// second's go through centres of the range's primitives, which are dense where those are; later
/// looks' lie around each axis' best plane so far, ever closer.
Plane make_plane(Task task, uint look, uint id) {
    Plane plane;
    plane.axis = (id + (look == 1 ? kPlanes : 0)) % 3;  // the second look deals on
    plane.left = plane.right = empty_keys();
    plane.left_count = 0;
    if (look == 1) {
        const uint turn = min(id, kPlanes - 1);
        const uint place = uint((uint64_t(turn) * 2 + 1) * task.count / (2 * kPlanes));
        const uint mine = order_of(task.side).at[task.first + place];
        const Primitive primitive = pool.client.primitives.at[mine];
        precise vec3 center = primitive.lower + primitive.upper;
        plane.position = component(center, plane.axis);
        return plane;
    }
    precise float extent = component(task.center_upper - task.center_lower, plane.axis);
    const uint on_axis = (kPlanes - plane.axis + 2) / 3;
    const float even = fraction(id / 3 + 1, on_axis + 1);
    float origin = component(task.center_lower, plane.axis), offset = even;
    if (look > 1) {
        float spacing = fraction(1, on_axis + 1);
        for (uint before = 2; before < look; ++before) spacing *= fraction(2, on_axis + 1);
        origin = component(task.axis_position, plane.axis);
        offset = spacing * (2.0 * even - 1.0);
    }
    precise float position = origin + extent * offset;
    plane.position = position;
    return plane;
}

/// Cost without the constant factors: area * count over both sides; infinite if one side is empty.
float plane_cost(Plane plane, uint count) {
    precise float cost = half_area(plane.left) * float(plane.left_count) +
                         half_area(plane.right) * float(count - plane.left_count);
    return plane.left_count == 0 || plane.left_count == count ? kInfinity : cost;
}

const uint kUnroll = 4;  // primitives passed per iteration; the subgroup size is a multiple of it

/// Passes the primitives of [begin, end) by the planes.
void pass_primitives(Task task, uint begin, uint end, inout Plane planes[kRows]) {
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint present = min(end - i, gl_SubgroupSize);
        const uint mine = order_of(task.side).at[i + min(gl_SubgroupInvocationID, present - 1)];
        const Primitive primitive = pool.client.primitives.at[mine];
        precise vec3 center = primitive.lower + primitive.upper;
        const KeyBox box = keys_of(primitive.lower, primitive.upper);
        for (uint first = 0; first < present; first += kUnroll) {
            // Lanes from `present` on hold the last primitive again: it changes no box.
            vec3 place[kUnroll];
            KeyBox passing[kUnroll];
            [[unroll]] for (uint k = 0; k < kUnroll; ++k) {
                place[k] = subgroupShuffle(center, first + k);
                passing[k] = KeyBox(subgroupShuffle(box.low, first + k),
                                    subgroupShuffle(box.high, first + k));
            }
            [[unroll]] for (uint row = 0; row < kRows; ++row) {
                Plane plane = planes[row];
                [[unroll]] for (uint k = 0; k < kUnroll; ++k) {
                    const uint left =
                        component(place[k], plane.axis) <= plane.position ? 0xffffffffu : 0;
                    plane.left = join(plane.left, masked(left, passing[k]));
                    plane.right = join(plane.right, masked(~left, passing[k]));
                    plane.left_count += left & (first + k < present ? 1 : 0);
                }
                planes[row] = plane;
            }
        }
        pool_spend(present / kUnroll + 3);
    }
}

/// Per axis: whether a plane of the given cost and position is to replace that of `cost`, `position`.
bvec3 is_better(bvec3 among, vec3 new_cost, vec3 new_position, vec3 cost, vec3 position) {
    const uvec3 less = uvec3(lessThan(new_cost, cost)), equally = uvec3(equal(new_cost, cost));
    return bvec3(uvec3(among) & (less | (equally & uvec3(lessThan(new_position, position)))));
}

/// Makes the best of all lanes' planes the task's, per axis and over all axes, if they beat those of
/// the looks before. Equal costs: the lower position, the earlier axis.
void choose_plane(inout Task task, Plane planes[kRows]) {
    vec3 cost = task.axis_cost, position = task.axis_position;
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint id = row * gl_SubgroupSize + gl_SubgroupInvocationID;
        const float mine = id < kPlanes ? plane_cost(planes[row], task.count) : kInfinity;
        const bvec3 better = bvec3(uvec3(planes[row].axis == 0, planes[row].axis == 1,
                                         planes[row].axis == 2) *
                                   uint(mine < kInfinity));
        const bvec3 take = is_better(better, vec3(mine), vec3(planes[row].position), cost, position);
        cost = mix(cost, vec3(mine), take);
        position = mix(position, vec3(planes[row].position), take);
    }
    for (uint apart = gl_SubgroupSize / 2; apart > 0; apart /= 2) {
        const vec3 other = subgroupShuffleXor(cost, apart);
        const vec3 place = subgroupShuffleXor(position, apart);
        const bvec3 take = is_better(bvec3(true), other, place, cost, position);
        cost = mix(cost, other, take);
        position = mix(position, place, take);
    }
    pool_spend(kReduceIterations);
    task.axis_cost = cost;
    task.axis_position = position;
    const uint axis = cost.x <= cost.y && cost.x <= cost.z ? 0 : cost.y <= cost.z ? 1 : 2;
    if (component(cost, axis) < kInfinity) {
        task.rule = kRulePlane;
        task.axis = axis;
        task.position = component(position, axis);
    }
}

void make_planes(Task task, uint look, out Plane planes[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row)
        planes[row] = make_plane(task, look, row * gl_SubgroupSize + gl_SubgroupInvocationID);
    pool_spend(kRows * (look + 2));
}
