// Ball tree build on the task pool: top down, each range of points split in the middle of the longest
// side of its bounds. (The k-d construction of Omohundro, "Five Balltree Construction Algorithms", 1989,
// splits the widest dimension at the median instead, which takes a selection.)
//
// A task owns a range of points. kPhaseMeasure finds its ball's radius and counts, kPhasePartition
// moves the points stably to the other of two buffers, the left ones first. Where a point or node
// lands depends on the input alone, so equal inputs give equal trees.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"
#include "structures/ball_tree/ball_tree_shared.h"

layout(constant_id = 16) const uint kLeafSize = 8;

struct Task {
    uint first, count;
    uint node, depth;
    uint side;  // which point buffer holds the range
    uint left_count;
    vec3 lower, upper;  // bounds of the points
    vec3 left_lower, left_upper, right_lower, right_upper;
};

pool_buffer(4) Points { BallPoint at[]; };
pool_buffer(4) Nodes { BallNode at[]; };
pool_buffer(4) Gathers { Gather at[]; };

struct Client {
    Vec3Array positions;
    Uvec3Array triangles;
    Points points[2];  // the tree's points end up in the first
    Nodes nodes;
    Gathers gathers;
};
#include "taskpool/pool/pool.glsl"

// ---- Chunks ---------------------------------------------------------------------------------------

/// The last chunk takes the rest, so every chunk has more than kLeafSize points, or its task all to
/// itself: chunks of different tasks never begin in the same multiple of kLeafSize.
uint chunk_count(uint count) { return max(count / kChunkPoints, 1u); }
uint gather_of(uint first) { return first / kLeafSize; }

BallPoint load_point(uint side, uint place) {
    BallPoint point;
    if (side == 0) point = pool.client.points[0].at[place];
    else point = pool.client.points[1].at[place];
    return point;
}
void store_point(uint side, uint place, BallPoint point) {
    if (side == 0) pool.client.points[0].at[place] = point;
    else pool.client.points[1].at[place] = point;
}

// `precise` wherever the tree depends on it: the host's reference computes the same bits.

float distance_squared(vec3 a, vec3 b) {
    precise vec3 d = a - b;
    precise float sum = d.x * d.x + d.y * d.y + d.z * d.z;
    return sum;
}
vec3 center_of(vec3 lower, vec3 upper) {
    precise vec3 center = 0.5 * lower + 0.5 * upper;
    return center;
}

/// Exactly no area or a corner that is not finite, as TriangleMesh::degenerate decides it.
bool degenerate(vec3 a, vec3 b, vec3 c) {
    precise dvec3 u = dvec3(b) - dvec3(a), v = dvec3(c) - dvec3(a);
    precise dvec3 normal = dvec3(u.y * v.z - v.y * u.z, u.z * v.x - v.z * u.x, u.x * v.y - v.x * u.y);
    precise double square = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
    return !(square > 0.0LF && square < 1e300LF);
}

/// Keys that order like the floats they stand for; 0 is below all of them.
uvec3 key_of(vec3 v) {
    const uvec3 bits = floatBitsToUint(v);
    return bits ^ mix(uvec3(0x80000000u), uvec3(0xffffffffu), greaterThanEqual(bits, uvec3(0x80000000u)));
}
vec3 from_key(uvec3 key) {
    return uintBitsToFloat(
        key ^ mix(uvec3(0xffffffffu), uvec3(0x80000000u), greaterThanEqual(key, uvec3(0x80000000u))));
}

/// Which points of a task go left: those up to `position` on `axis`; or the first half, if the plane
/// separates nothing or the tree gets too deep; or, of the root task, those that are points at all.
struct Split {
    bool drop, halve;
    uint axis;
    float position;
    uint middle;
};
Split split_of(Task task) {
    Split split;
    precise vec3 extent = task.upper - task.lower;
    split.drop = task.node == kNoNode;
    split.halve =
        task.depth + uint(findMSB(task.count)) + 1 >= kMaxDepth || extent == vec3(0);
    split.axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    split.position = center_of(task.lower, task.upper)[split.axis];
    // Neighbouring floats have no middle.
    if (split.position >= task.upper[split.axis]) split.position = task.lower[split.axis];
    split.middle = task.first + task.count / 2;
    return split;
}
bool goes_left(Split split, BallPoint point, uint place) {
    if (split.drop) return point.id != kNoPoint;
    return split.halve ? place < split.middle : point.position[split.axis] <= split.position;
}

void setup_chunk(uint begin, uint end) {
    uint valid_count = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const uvec3 corners = pool.client.triangles.at[min(mine, end - 1)];
        const vec3 a = pool.client.positions.at[corners.x], b = pool.client.positions.at[corners.y],
                   c = pool.client.positions.at[corners.z];
        const bool valid = mine < end && !degenerate(a, b, c);
        // Divided before they are summed: no overflow.
        const float third = 1.0 / 3.0;
        precise vec3 position = a * third + b * third + c * third;
        if (mine < end) store_point(0, mine, BallPoint(position, valid ? mine : kNoPoint));
        valid_count += subgroupBallotBitCount(subgroupBallot(valid));
    }
    if (subgroupElect()) pool.client.gathers.at[gather_of(begin)].left_count = valid_count;
}

void measure_chunk(Task task, uint begin, uint end) {
    const Split split = split_of(task);
    const vec3 center = center_of(task.lower, task.upper);
    uint left_count = 0;
    float farthest = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const BallPoint point = load_point(task.side, min(mine, end - 1));
        const bool left = mine < end && goes_left(split, point, mine);
        left_count += subgroupBallotBitCount(subgroupBallot(left));
        farthest = max(farthest, distance_squared(center, point.position));
    }
    farthest = subgroupMax(farthest);
    if (!subgroupElect()) return;
    pool.client.gathers.at[gather_of(begin)].left_count = left_count;
    atomicMax(pool.client.gathers.at[gather_of(task.first)].radius_squared, floatBitsToUint(farthest));
}

void gather_corner(Task task, uint corner, uvec3 key) {
    const uvec3 most = subgroupMax(key);
    pool_spend(3);
    if (!subgroupElect()) return;
    for (uint k = 0; k < 3; ++k)
        atomicMax(pool.client.gathers.at[gather_of(task.first)].bounds[3 * corner + k], most[k]);
}

void partition_chunk(Task task, uint begin, uint end) {
    const Split split = split_of(task);
    const uint before = pool.client.gathers.at[gather_of(begin)].left_count;
    uint left_place = task.first + before;
    uint right_place = begin + task.left_count - before;
    uvec3 left_low = uvec3(0), left_high = uvec3(0), right_low = uvec3(0), right_high = uvec3(0);
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const BallPoint point = load_point(task.side, min(mine, end - 1));
        const bool left = mine < end && goes_left(split, point, mine);
        const bool right = mine < end && !left;
        const uvec4 lefts = subgroupBallot(left), rights = subgroupBallot(right);
        const uvec3 key = key_of(point.position);
        if (left) {
            store_point(1 - task.side, left_place + subgroupBallotExclusiveBitCount(lefts), point);
            left_low = max(left_low, ~key);
            left_high = max(left_high, key);
        }
        if (right) {
            store_point(1 - task.side, right_place + subgroupBallotExclusiveBitCount(rights), point);
            right_low = max(right_low, ~key);
            right_high = max(right_high, key);
        }
        left_place += subgroupBallotBitCount(lefts);
        right_place += subgroupBallotBitCount(rights);
    }
    gather_corner(task, 0, left_low);
    gather_corner(task, 1, left_high);
    gather_corner(task, 2, right_low);
    gather_corner(task, 3, right_high);
}

void leaf_chunk(Task task, uint chunk, uint begin, uint end) {
    const vec3 center = center_of(task.lower, task.upper);
    float farthest = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const BallPoint point = load_point(task.side, min(mine, end - 1));
        if (mine < end && task.side != 0) store_point(0, mine, point);
        farthest = max(farthest, distance_squared(center, point.position));
    }
    // A leaf of several chunks has one position only.
    farthest = subgroupMax(farthest);
    if (chunk == 0 && subgroupElect())
        pool.client.nodes.at[task.node] = BallNode(center, farthest, task.first, task.count);
}

// Every loop tells pool_spend() of its iterations: a driver may cut loops beyond a limit, silently.

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    const uint begin = task.first + chunk * kChunkPoints;
    const uint end =
        chunk + 1 == chunk_count(task.count) ? task.first + task.count : begin + kChunkPoints;
    switch (phase) {
        case kPhaseSetup: setup_chunk(begin, end); break;
        case kPhaseMeasure: measure_chunk(task, begin, end); break;
        case kPhasePartition: partition_chunk(task, begin, end); break;
        case kPhaseLeaf: leaf_chunk(task, chunk, begin, end); break;
    }
    pool_spend((end - begin) / gl_SubgroupSize + 1);
}

// ---- Transitions ----------------------------------------------------------------------------------

/// Exclusive scan of the chunks' counts; returns their sum.
uint scan_left_counts(Task task) {
    const uint chunks = chunk_count(task.count);
    uint sum = 0;
    for (uint i = 0; i < chunks; i += gl_SubgroupSize) {
        const uint chunk = i + gl_SubgroupInvocationID;
        const uint at = gather_of(task.first + min(chunk, chunks - 1) * kChunkPoints);
        const uint mine = chunk < chunks ? pool.client.gathers.at[at].left_count : 0;
        const uint before = sum + subgroupExclusiveAdd(mine);
        if (chunk < chunks) pool.client.gathers.at[at].left_count = before;
        sum += subgroupAdd(mine);
        pool_spend(1);
    }
    pool_order_lanes();  // the next step may run at once, and other lanes read these words
    return sum;
}

vec3 gathered_corner(Task task, uint corner) {
    uvec3 key;
    for (uint k = 0; k < 3; ++k)
        key[k] = pool.client.gathers.at[gather_of(task.first)].bounds[3 * corner + k];
    pool_spend(3);
    return from_key((corner & 1) == 0 ? ~key : key);
}

void write_node(Task task, BallNode node) {
    if (subgroupElect()) pool.client.nodes.at[task.node == kNoNode ? 0 : task.node] = node;
}

Next finish_step(inout Task task, uint phase, uint step) {
    if (phase == kPhaseLeaf) {
        pool_progress(task.count);
        return next_end();
    }
    if (phase == kPhaseSetup || phase == kPhaseMeasure) {
        task.left_count = task.count == 0 ? 0 : scan_left_counts(task);
        if (phase == kPhaseSetup && task.left_count == 0) {
            write_node(task, BallNode(vec3(0), 0, 0, 0));
            return next_end();
        }
        return next_step(kPhasePartition, 0, chunk_count(task.count));
    }
    task.left_lower = gathered_corner(task, 0);
    task.left_upper = gathered_corner(task, 1);
    task.right_lower = gathered_corner(task, 2);
    task.right_upper = gathered_corner(task, 3);
    if (task.node == kNoNode) return next_spawn(1);
    // Ranges are split at different places, so nodes need no counter.
    const uint radius_bits = pool.client.gathers.at[gather_of(task.first)].radius_squared;
    write_node(task, BallNode(center_of(task.lower, task.upper), uintBitsToFloat(radius_bits),
                              2 * (task.first + task.left_count) - 1, 0));
    return next_spawn(2);
}

Task spawn_child(Task parent, uint child, out Start start) {
    Task task = parent;
    task.side = 1 - parent.side;
    task.node = parent.node == kNoNode ? 0 : 2 * (parent.first + parent.left_count) - 1 + child;
    task.depth = parent.node == kNoNode ? 0 : parent.depth + 1;
    if (child == 0) {
        task.count = parent.left_count;
        task.lower = parent.left_lower;
        task.upper = parent.left_upper;
    } else {
        task.first += parent.left_count;
        task.count -= parent.left_count;
        task.lower = parent.right_lower;
        task.upper = parent.right_upper;
    }
    const bool leaf = task.count <= kLeafSize || task.lower == task.upper;
    if (!leaf && subgroupElect()) {
        pool.client.gathers.at[gather_of(task.first)].radius_squared = 0;
        for (uint k = 0; k < 12; ++k) pool.client.gathers.at[gather_of(task.first)].bounds[k] = 0;
    }
    pool_spend(12);
    start = Start(leaf ? kPhaseLeaf : kPhaseMeasure, 0, chunk_count(task.count), 0);
    return task;
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
