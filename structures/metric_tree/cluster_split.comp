// Chunks of triangles along the Morton curve to parts of at most max_triangles, by k-means on the
// task pool: k_means.cpp with the lanes of a subgroup.
//
// A task owns a range of the order, of at most kChunk triangles, and reorders it part by part. Full
// parts are marked with their size where they begin; larger ones become tasks. What a range becomes
// depends on the range alone, so equal inputs give equal parts on a device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"

const uint kPhaseAll = 0, kPhaseSplit = 1;
const uint kChunk = 512, kMeans = 8, kCandidates = 8, kRounds = 4;

struct Task {
    uint first, count;
    uint part_count;  // too large ones; 0 in the root, whose parts are the chunks
    uint begins[kMeans], ends[kMeans];
};

struct Client {
    Vec3Array positions;
    Uvec3Array triangles;
    PoolUints order;
    PoolUints marks;  // a word per place in the order, 0 before
    UintArray kept;   // how many triangles the order holds
    uint seed;
    uint max_triangles;
};
#include "taskpool/pool/pool.glsl"

// Boxes of the range's triangles, scaled to 0 to 1.
shared vec3 lowers[kChunk], uppers[kChunk];
shared uint ids[kChunk], labels[kChunk];
shared vec3 mean_lowers[kMeans], mean_uppers[kMeans];

const float kInfinity = 1.0 / 0.0;

/// Squared distance of boxes as points in six dimensions.
float square_between(uint i, uint mean) {
    const vec3 low = lowers[i] - mean_lowers[mean], high = uppers[i] - mean_uppers[mean];
    return dot(low, low) + dot(high, high);
}

/// The place of the greatest value, the first of equal ones.
uint place_of_greatest(float value, uint place) {
    return subgroupMin(value == subgroupMax(value) ? place : 0xffffffffu);
}

/// PCG hash (M. O'Neill, 2014; M. Jarzynski and M. Olano, 2020).
uint hash(uint x) {
    const uint state = x * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

void load(Task task) {
    subgroup_sync();  // after the task before
    vec3 least = vec3(kInfinity), most = vec3(-kInfinity);
    for (uint i = gl_SubgroupInvocationID; i < task.count; i += gl_SubgroupSize) {
        ids[i] = pool.client.order.at[task.first + i];
        const uvec3 corners = pool.client.triangles.at[ids[i]];
        const vec3 a = pool.client.positions.at[corners.x], b = pool.client.positions.at[corners.y],
                   c = pool.client.positions.at[corners.z];
        lowers[i] = min(min(a, b), c);
        uppers[i] = max(max(a, b), c);
        least = min(least, lowers[i]);
        most = max(most, uppers[i]);
    }
    least = subgroupMin(least);
    const vec3 extent = subgroupMax(most) - least;
    const float size = max(max(extent.x, extent.y), extent.z);
    const float scale = size > 1e-37 ? 1 / size : 0;
    for (uint i = gl_SubgroupInvocationID; i < task.count; i += gl_SubgroupSize) {
        lowers[i] = (lowers[i] - least) * scale;
        uppers[i] = (uppers[i] - least) * scale;
    }
    subgroup_sync();
    pool_spend(2 * (kChunk / gl_SubgroupSize));
}

/// Each mean begins at the candidate that is farthest from those before it.
void seed_means(Task task, uint mean_count) {
    const uint start = hash(task.first + hash(pool.client.seed));
    for (uint m = 0; m < mean_count; ++m) {
        float farthest = -1;
        uint place = 0;
        for (uint c = gl_SubgroupInvocationID; c < kCandidates; c += gl_SubgroupSize) {
            const uint candidate = hash(start + m * kCandidates + c) % task.count;
            float nearest = kInfinity;
            for (uint before = 0; before < m; ++before)
                nearest = min(nearest, square_between(candidate, before));
            if (nearest > farthest) {
                farthest = nearest;
                place = candidate;
            }
        }
        place = place_of_greatest(farthest, place);
        if (subgroupElect()) {
            mean_lowers[m] = lowers[place];
            mean_uppers[m] = uppers[place];
        }
        subgroup_sync();
        pool_spend(1 + (kCandidates / gl_SubgroupSize + 1) * (m + 1));
    }
}

/// Every triangle to its nearest mean; returns the one that is farthest from its own.
uint assign(Task task, uint mean_count) {
    float farthest = -1;
    uint place = 0;
    for (uint i = gl_SubgroupInvocationID; i < task.count; i += gl_SubgroupSize) {
        float nearest = kInfinity;
        uint label = 0;
        for (uint m = 0; m < mean_count; ++m) {
            const float square = square_between(i, m);
            label = square < nearest ? m : label;
            nearest = min(square, nearest);
        }
        labels[i] = label;
        if (nearest > farthest) {
            farthest = nearest;
            place = i;
        }
    }
    subgroup_sync();
    pool_spend((mean_count + 1) * (kChunk / gl_SubgroupSize));
    return place_of_greatest(farthest, place);
}

/// Means to the middle of their triangles, one without triangles to `farthest`. False if none
/// moved.
bool move_means(Task task, uint mean_count, uint farthest) {
    bool moved = false, reseeded = false;
    for (uint m = 0; m < mean_count; ++m) {
        vec3 lower = vec3(0), upper = vec3(0);
        uint count = 0;
        for (uint i = gl_SubgroupInvocationID; i < task.count; i += gl_SubgroupSize) {
            if (labels[i] != m) continue;
            lower += lowers[i];
            upper += uppers[i];
            ++count;
        }
        count = subgroupAdd(count);
        lower = subgroupAdd(lower) / float(max(count, 1));
        upper = subgroupAdd(upper) / float(max(count, 1));
        if (count == 0) {
            const bool take = !reseeded;
            lower = take ? lowers[farthest] : mean_lowers[m];
            upper = take ? uppers[farthest] : mean_uppers[m];
            reseeded = true;
        }
        moved = moved || lower != mean_lowers[m] || upper != mean_uppers[m];
        subgroup_sync();
        if (subgroupElect()) {
            mean_lowers[m] = lower;
            mean_uppers[m] = upper;
        }
        subgroup_sync();
    }
    pool_spend(mean_count * (1 + kChunk / gl_SubgroupSize));
    return moved;
}

/// Marks a part of the range that is small enough; keeps another for a task of its own.
void add_part(inout Task task, uint begin, uint end) {
    if (end - begin <= pool.client.max_triangles) {
        if (subgroupElect()) pool.client.marks.at[task.first + begin] = end - begin;
        pool_progress(end - begin);
        return;
    }
    task.begins[task.part_count] = task.first + begin;
    task.ends[task.part_count] = task.first + end;
    ++task.part_count;
}

/// Brings the triangles of each mean together, in the order they had.
void gather_parts(inout Task task, uint mean_count) {
    uint next = 0;
    bool alike = false;
    for (uint m = 0; m < mean_count; ++m) {
        const uint begin = next;
        for (uint base = 0; base < task.count; base += gl_SubgroupSize) {
            const uint i = base + gl_SubgroupInvocationID;
            const bool mine = i < task.count && labels[min(i, kChunk - 1)] == m;
            const uvec4 ballot = subgroupBallot(mine);
            if (mine)
                pool.client.order.at[task.first + next + subgroupBallotExclusiveBitCount(ballot)] =
                    ids[i];
            next += subgroupBallotBitCount(ballot);
        }
        alike = alike || next - begin == task.count;
        if (next > begin && !alike) add_part(task, begin, next);
    }
    pool_spend(mean_count * (1 + kChunk / gl_SubgroupSize));
    if (!alike) return;
    // By their order, which is the curve's.
    for (uint m = 0; m < mean_count; ++m)
        add_part(task, m * task.count / mean_count, (m + 1) * task.count / mean_count);
    pool_spend(mean_count);
}

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    const uint most = pool.client.max_triangles;
    const uint mean_count = min(kMeans, (task.count + most - 1) / most);
    if (mean_count == 1) {
        add_part(task, 0, task.count);
        return;
    }
    load(task);
    seed_means(task, mean_count);
    // One call each: hooks are inlined.
    bool moved = true;
    for (uint r = 0; moved; ++r) {
        const uint farthest = assign(task, mean_count);
        moved = r < kRounds && move_means(task, mean_count, farthest);
    }
    gather_parts(task, mean_count);
    pool_spend(kRounds + 1);
}

Next finish_step(inout Task task, uint phase, uint step) {
    if (phase == kPhaseAll) {
        task.count = pool.client.kept.at[0];
        return next_spawn((task.count + kChunk - 1) / kChunk);
    }
    if (task.part_count == 0) return next_end();
    return next_spawn(task.part_count);
}

Task spawn_child(Task parent, uint child, out Start start) {
    Task task = parent;
    task.part_count = 0;
    if (parent.part_count == 0) {
        task.first = child * kChunk;
        task.count = min(kChunk, parent.count - task.first);
    } else {
        task.first = parent.begins[child];
        task.count = parent.ends[child] - task.first;
    }
    start = Start(kPhaseSplit, 0, 1, 0);
    return task;
}

void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
