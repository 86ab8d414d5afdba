// SAH over candidate planes: each lane owns kRows planes and keeps, in registers, the boxes of what
// lies on either side; primitives pass by one at a time (paper, section 4.1: a thread per plane).
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

/// Plane `id` of kPlanes of a look. The first look mixes evenly spaced planes inside the centres'
/// bounds with planes through centres of the range's primitives, which are dense where those are; later
/// looks refine around the best plane so far. Fractions are exact: every device makes the same planes.
Plane make_plane(Task task, uint look, uint id) {
    Plane plane;
    plane.axis = id % 3;
    plane.left = plane.right = empty_keys();
    plane.left_count = 0;
    const uint even = kPlanes / 2;
    if (look == 0 && id >= even) {
        const uint turn = min(id, kPlanes - 1) - even;
        const uint place = uint((uint64_t(turn) * 2 + 1) * task.count / (2 * (kPlanes - even)));
        const uint mine = order_of(task.side).at[task.first + place];
        const Primitive primitive = pool.client.primitives.at[mine];
        precise vec3 center = primitive.lower + primitive.upper;
        plane.position = component(center, plane.axis);
        return plane;
    }
    const uint planes_on_axis = (even - plane.axis + 2) / 3;
    const float spacing = float(65536 / (planes_on_axis + 1)) / 65536.0;
    if (look > 0) plane.axis = task.axis;
    precise float extent = component(task.center_upper - task.center_lower, plane.axis);
    const float offset = look > 0 ? spacing * (float(int(131072 * (id + 1) / (kPlanes + 1)) - 65536) / 65536.0)
                                  : float(65536 * (id / 3 + 1) / (planes_on_axis + 1)) / 65536.0;
    const float origin = look > 0 ? task.position : component(task.center_lower, plane.axis);
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
            [[unroll]] for (uint k = 0; k < kUnroll; ++k) {
                // Lanes from `present` on hold the last primitive again: it changes no box.
                const uint lane = first + k;
                const uint counted = lane < present ? 1 : 0;
                const vec3 place = subgroupShuffle(center, lane);
                const KeyBox passing = KeyBox(subgroupShuffle(box.low, lane), subgroupShuffle(box.high, lane));
                [[unroll]] for (uint row = 0; row < kRows; ++row) {
                    const uint left =
                        component(place, planes[row].axis) <= planes[row].position ? 0xffffffffu : 0;
                    planes[row].left = join(planes[row].left, masked(left, passing));
                    planes[row].right = join(planes[row].right, masked(~left, passing));
                    planes[row].left_count += left & counted;
                }
            }
        }
        pool_spend(present / kUnroll + 2);
    }
}

/// Makes the best of all lanes' planes the task's, if it beats those of the looks before. Equal
/// costs: the earlier look, then the plane with the lowest id.
void choose_plane(inout Task task, Plane planes[kRows]) {
    float best = kInfinity;
    uint id = kNoPlane, axis = 0;
    float position = 0;
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint mine = row * gl_SubgroupSize + gl_SubgroupInvocationID;
        const float cost = mine < kPlanes ? plane_cost(planes[row], task.count) : kInfinity;
        if (cost < best) {
            best = cost;
            id = mine;
            axis = planes[row].axis;
            position = planes[row].position;
        }
    }
    const float least = subgroupMin(best);
    if (least >= task.cost) return;
    const uint winner = subgroupMin(best == least ? id : kNoPlane);
    const uint lane = winner % gl_SubgroupSize;
    task.cost = least;
    task.rule = kRulePlane;
    task.axis = subgroupShuffle(axis, lane);
    task.position = subgroupShuffle(position, lane);
}

void make_planes(Task task, uint look, out Plane planes[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row)
        planes[row] = make_plane(task, look, row * gl_SubgroupSize + gl_SubgroupInvocationID);
}
