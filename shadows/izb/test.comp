// Tests the entries' triangles against the points of their cells. Cells with many points, and those
// for which this invocation has no loop iterations left, become ranges, of which the list has room
// for job.y.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/test.glsl"

void leave_to_ranges(uint begin, uint end) {
    const uint count = (end - begin + kRangePoints - 1u) / kRangePoints;
    uint base = 0;
    if (lane() == 0) {
        // A list that has overflowed is not counted further, lest the count wraps.
        base = push.status.at.counts[kRanges];
        if (base <= push.job.y) base = atomicAdd(push.status.at.counts[kRanges], count);
    }
    base = subgroupBroadcastFirst(base);
    for (uint i = lane(); i < count; i += gl_SubgroupSize) {
        if (base + i >= push.job.y) break;
        const uint first = begin + i * kRangePoints;
        push.ranges.at[base + i] = IzbRange(entry_index, first, min(first + kRangePoints, end));
    }
}

void visit_cell(uint cell, uint begin, uint end) {
    const uint batches = (end - begin + gl_SubgroupSize - 1u) / gl_SubgroupSize;
    if (end - begin > kRangePoints || batches > batches_left) {
        leave_to_ranges(begin, end);
        return;
    }
    batches_left -= batches;
    const float farthest = reduce_min(test_points(begin, end));
    // Others may write this at the same time, for fewer shadowed points: still a bound.
    if (lane() == 0) push.farthest.at[cell] = farthest < kHuge ? ordered(farthest) : kNobody;
}

// Visits a block of at most 8 x 8 cells.
void visit_cells(IzbFace face, uvec2 first, uvec2 last) {
    const uvec2 size = last - first + 1u;
    const uint count = size.x * size.y;
    const float rows_per_cell = 1.0 / float(size.x);
    for (uint done = 0; done < count; done += gl_SubgroupSize) {
        const uint i = done + lane();
        const uint y = uint((float(i) + 0.5) * rows_per_cell), x = i - y * size.x;
        const uvec2 at = first + uvec2(x, y);
        const uint cell = face.level_first[0] + (at.y << face.log_width) + at.x;
        bool visit = false;
        uint begin = 0, end = 0;
        if (i < count) {
            const uint key = push.farthest.at[cell];
            const Rectangle r = cells_rectangle(face.lower, face.cell, face.pad, at, at);
            visit = key != kNobody && may_occlude(entry_caster, r, from_ordered(key));
            if (visit) {
                begin = push.cells.at[cell];
                end = push.cells.at[cell + 1];
            }
        }
        uvec4 votes = subgroupBallot(visit);
        if (votes.xy == uvec2(0)) continue;
        while (true) {
            const uint from = take_lane(votes);
            visit_cell(subgroupShuffle(cell, from), subgroupShuffle(begin, from),
                       subgroupShuffle(end, from));
            if (votes.xy == uvec2(0)) break;
        }
    }
}

void visit_entry() {
    const IzbFace face = push.frame.at.faces[entry_face];
    if (all(lessThan(entry_last - entry_first, uvec2(1u << kTileLog)))) {
        visit_cells(face, entry_first, entry_last);
        return;
    }
    // Within one row of tiles.
    const uint end = (entry_last.x >> kTileLog) + 1u;
    const uint log_row = max(face.log_width, kTileLog) - kTileLog;
    for (uint tile = entry_first.x >> kTileLog; tile < end; tile += gl_SubgroupSize) {
        const uint mine = tile + lane();
        const uvec2 first = max(entry_first, uvec2(mine << kTileLog, 0));
        const uvec2 last = min(entry_last, uvec2(((mine + 1u) << kTileLog) - 1u, 0xffffu));
        bool visit = false;
        if (mine < end) {
            const uint key = push.farthest.at[face.level_first[kTileLog] +
                                              ((entry_first.y >> kTileLog) << log_row) + mine];
            const Rectangle r = cells_rectangle(face.lower, face.cell, face.pad, first, last);
            visit = key != kNobody && may_occlude(entry_caster, r, from_ordered(key));
        }
        uvec4 votes = subgroupBallot(visit);
        if (votes.xy == uvec2(0)) continue;
        while (true) {
            const uint from = take_lane(votes);
            visit_cells(face, subgroupShuffle(first, from), subgroupShuffle(last, from));
            if (votes.xy == uvec2(0)) break;
        }
    }
}

void main() {
    const vec3 origin = push.frame.at.origin;
    const float scale = push.frame.at.scale;
    const vec2 tilt = push.frame.at.tilt;
    batches_left = kBatchLimit;
    test_count = exact_count = 0;
    const uint count = push.status.at.counts[kEntries];
    for (uint taken = 0; taken < kChunksPerGroup; ++taken) {
        uint first = 0;
        if (lane() == 0) first = atomicAdd(push.status.at.next_entry, kChunkEntries);
        first = subgroupBroadcastFirst(first);
        if (first >= count) break;
        const uint index = first + lane();
        const bool used = lane() < kChunkEntries && index < count;
        const Held held = hold(index, used, origin, scale, tilt);
        uvec4 votes = subgroupBallot(held.used);
        while (true) {
            turn_to(held, take_lane(votes));
            visit_entry();
            if (votes.xy == uvec2(0)) break;
        }
    }
    add_statistics();
}
