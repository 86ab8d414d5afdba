// Finds the cells that each triangle may shadow points in, and lists them as entries; a triangle
// with many cells as several. Lane i takes triangle job.x + i, up to job.y; the list has room for
// job.z entries.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/caster.glsl"

struct Cells {
    uvec2 first, last;
};

// Cells of the face whose points may lie in the rectangle: count.comp's arithmetic, which never
// decreases with u, on widened bounds.
Cells cells_of(Rectangle r, uint face) {
    const vec2 lower = push.frame.at.faces[face].lower, pad = push.frame.at.faces[face].pad;
    const vec2 per_unit = push.frame.at.faces[face].cells_per_unit;
    const uvec2 last = (uvec2(1u) << uvec2(push.frame.at.faces[face].log_width,
                                           push.frame.at.faces[face].log_height)) -
                       1u;
    const vec2 most = vec2(last);
    const vec2 from = clamp((r.lower - pad - lower) * per_unit, vec2(0), most);
    const vec2 to = clamp((r.upper + pad - lower) * per_unit, vec2(0), most);
    return Cells(uvec2(from), uvec2(to));
}

// Smallest k of the points in these cells and some around them, as an ordered word: from the level
// of the pyramid at which they are two nodes wide at most.
uint farthest_of(Cells cells, uint face) {
    const uvec2 extent = cells.last - cells.first;
    const uint widest = max(extent.x, extent.y);
    const uint level = widest < 2u ? 0u : uint(findMSB(widest - 1u)) + 1u;
    const uint log_width = push.frame.at.faces[face].log_width;
    const uint row = 1u << (max(log_width, level) - level);
    const uvec2 low = cells.first >> level, high = cells.last >> level;
    const uint node = push.frame.at.faces[face].level_first[level];
    return min(min(push.farthest.at[node + low.y * row + low.x],
                   push.farthest.at[node + low.y * row + high.x]),
               min(push.farthest.at[node + high.y * row + low.x],
                   push.farthest.at[node + high.y * row + high.x]));
}

// Where `count` entries go. A list that has overflowed is not counted further, lest the count
// wraps.
uint reserve(uint count) {
    const uint listed = push.status.at.counts[kEntries];
    return listed > push.job.z ? listed : atomicAdd(push.status.at.counts[kEntries], count);
}

void main() {
    const uint index = push.job.x + workgroup() * gl_SubgroupSize + lane();
    const vec3 origin = push.frame.at.origin;
    const float scale = push.frame.at.scale;
    const vec2 tilt = push.frame.at.tilt;
    const bool used = index < push.job.y;
    CornerTriangle triangle;
    if (used) triangle = corner_triangle(push.triangles, index);
    for (uint face = 0; face < kFaces; ++face) {
        if (push.frame.at.faces[face].points == 0) continue;
        bool keep = used;
        Cells cells;
        float reach = push.frame.at.faces[face].reach;
        if (keep) {
            const Corners corners = corners_of(triangle, origin, scale, face);
            const vec2 pad = push.frame.at.faces[face].pad;
            Rectangle r = Rectangle(push.frame.at.faces[face].lower - pad,
                                    push.frame.at.faces[face].upper + pad);
            keep = footprint(corners, tilt, reach, r);
            if (keep) {
                cells = cells_of(r, face);
                const uint key = farthest_of(cells, face);
                keep = key != kNobody;
                if (keep) {
                    const float farthest = from_ordered(key);
                    if (!kDirectional) reach = min(reach, 3.0001 / farthest);
                    const Rectangle block = cells_rectangle(face, cells.first, cells.last);
                    // Only the triangle's own rectangle counts, but entries are of whole cells.
                    keep = may_occlude(make_caster(corners, tilt, block, reach), r, farthest);
                }
            }
        }
        if (!subgroupAny(keep)) continue;
        const uvec2 extent = keep ? cells.last - cells.first + 1u : uvec2(0);
        const bool small = all(lessThanEqual(extent, uvec2(1u << kTileLog)));
        // Rows of tiles, cut into pieces.
        const uint first_row = cells.first.y >> kTileLog;
        const uint rows = (cells.last.y >> kTileLog) - first_row + 1u;
        const uint pieces = (extent.x + kRowCells - 1u) / kRowCells;
        const uint count = !keep ? 0u : small ? 1u : rows * pieces;
        const uint before = subgroupExclusiveAdd(count), total = subgroupAdd(count);
        uint base = 0;
        if (lane() == 0) base = reserve(total);
        base = subgroupBroadcastFirst(base) + before;
        const uint caster = index | face << kFaceShift;
        for (uint i = 0; i < count; ++i) {
            if (base + i >= push.job.z) break;
            uvec2 first = cells.first, last = cells.last;
            if (!small) {
                const uint row = first_row + i / pieces, piece = i % pieces;
                first = max(first, uvec2(first.x + piece * kRowCells, row << kTileLog));
                last = min(last, uvec2(first.x + kRowCells - 1u, ((row + 1u) << kTileLog) - 1u));
            }
            push.entries.at[base + i] =
                IzbEntry(caster, first.x | first.y << 16, last.x | last.y << 16, reach);
        }
    }
}
