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

// Rounds of candidates; a task keeps the best plane of all it looks at.
const uint kRoundEven = 0;     // evenly spaced inside the centres' bounds, on all axes in turn
const uint kRoundCenters = 1;  // through centres of the range's primitives: dense where they are
const uint kRoundRefine = 2;   // on the best plane's axis, within one even spacing of it

/// Plane `id` of kPlanes of a round. All fractions are exact, so that every device makes the same.
Plane make_plane(Task task, uint round, uint id) {
    Plane plane;
    plane.axis = round == kRoundRefine ? task.axis : id % 3;
    plane.left = plane.right = empty_keys();
    plane.left_count = 0;
    const uint planes_on_axis = (kPlanes - plane.axis + 2) / 3;
    precise float extent = task.center_upper[plane.axis] - task.center_lower[plane.axis];
    if (round == kRoundCenters) {
        const uint place = uint((uint64_t(min(id, kPlanes - 1)) * 2 + 1) * task.count / (2 * kPlanes));
        const Primitive primitive = load_primitive(task.side, task.first + place);
        precise vec3 center = primitive.lower + primitive.upper;
        plane.position = center[plane.axis];
    } else if (round == kRoundRefine) {
        const float spacing = float(65536 / (planes_on_axis + 1)) / 65536.0;
        const float offset = float(int(131072 * (id + 1) / (kPlanes + 1)) - 65536) / 65536.0;
        precise float fine = task.position + extent * spacing * offset;
        plane.position = fine;
    } else {
        const float fraction = float(65536 * (id / 3 + 1) / (planes_on_axis + 1)) / 65536.0;
        precise float coarse = task.center_lower[plane.axis] + extent * fraction;
        plane.position = coarse;
    }
    return plane;
}

KeyBox masked(uint mask, KeyBox box) { return KeyBox(box.low & mask, box.high & mask); }

/// Cost without the constant factors: area * count over both sides; infinite if one side is empty.
float plane_cost(Plane plane, uint count) {
    precise float cost = half_area(plane.left) * float(plane.left_count) +
                         half_area(plane.right) * float(count - plane.left_count);
    return plane.left_count == 0 || plane.left_count == count ? kInfinity : cost;
}

/// Groups of gl_SubgroupSize primitives of which large tasks look at one: their cost estimates are
/// means over thousands all the same.
uint sample_stride(Task task) { return task.count > kSampleAll ? 4 : 1; }

/// Passes the primitives of [begin, end) by the planes. Returns how many passed.
uint pass_primitives(Task task, uint begin, uint end, inout Plane planes[kRows]) {
    const uint stride = gl_SubgroupSize * sample_stride(task);
    uint count = 0;
    for (uint i = begin; i < end; i += stride) {
        const uint present = min(end - i, gl_SubgroupSize);
        const Primitive primitive =
            load_primitive(task.side, i + min(gl_SubgroupInvocationID, present - 1));
        precise vec3 center = primitive.lower + primitive.upper;
        const KeyBox box = keys_of(primitive.lower, primitive.upper);
        for (uint lane = 0; lane < present; ++lane) {
            const vec3 place = vec3(subgroupShuffle(center.x, lane), subgroupShuffle(center.y, lane),
                                    subgroupShuffle(center.z, lane));
            const KeyBox passing =
                KeyBox(uvec3(subgroupShuffle(box.low.x, lane), subgroupShuffle(box.low.y, lane),
                             subgroupShuffle(box.low.z, lane)),
                       uvec3(subgroupShuffle(box.high.x, lane), subgroupShuffle(box.high.y, lane),
                             subgroupShuffle(box.high.z, lane)));
            [[unroll]] for (uint row = 0; row < kRows; ++row) {
                const uint axis = planes[row].axis;
                const float value = axis == 0 ? place.x : axis == 1 ? place.y : place.z;
                const uint left = value <= planes[row].position ? 0xffffffffu : 0;
                planes[row].left = join(planes[row].left, masked(left, passing));
                planes[row].right = join(planes[row].right, masked(~left, passing));
                planes[row].left_count += left & 1;
            }
        }
        count += present;
        pool_spend(present + 1);
    }
    return count;
}

/// Makes the best of all lanes' planes the task's, if it beats those of the rounds before. Equal
/// costs: the earlier round, then the plane with the lowest id.
void choose_plane(inout Task task, Plane planes[kRows], uint count) {
    float best = kInfinity;
    uint id = kNoPlane, axis = 0;
    float position = 0;
    [[unroll]] for (uint row = 0; row < kRows; ++row) {
        const uint mine = row * gl_SubgroupSize + gl_SubgroupInvocationID;
        const float cost = mine < kPlanes ? plane_cost(planes[row], count) : kInfinity;
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

void make_planes(Task task, uint round, out Plane planes[kRows]) {
    [[unroll]] for (uint row = 0; row < kRows; ++row)
        planes[row] = make_plane(task, round, row * gl_SubgroupSize + gl_SubgroupInvocationID);
}
