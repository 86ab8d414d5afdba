// The root's first phases: boxes of the triangles, bounds of the scene, and, only if there are
// degenerate triangles, closing the gaps they leave.

/// Exactly no area or a corner that is not finite, by the same arithmetic as TriangleMesh::degenerate.
bool degenerate(vec3 a, vec3 b, vec3 c) {
    precise dvec3 u = dvec3(b) - dvec3(a), v = dvec3(c) - dvec3(a);
    precise double x = u.y * v.z - v.y * u.z;
    precise double y = u.z * v.x - v.z * u.x;
    precise double z = u.x * v.y - v.x * u.y;
    precise double square = x * x + y * y + z * z;
    return !(square > 0.0LF && square < 1e300LF);
}

void setup_chunk(uint begin, uint end) {
    BuildInput mesh = pool.client.mesh.data;
    KeyBox boxes[4] = no_boxes();
    uint valid_count = 0;
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        bool valid = mine < end;
        if (valid) {
            const uvec3 corners = mesh.triangles.at[mine];
            const vec3 a = mesh.positions.at[corners.x], b = mesh.positions.at[corners.y],
                       c = mesh.positions.at[corners.z];
            valid = !degenerate(a, b, c);
            const vec3 lower = min(min(a, b), c), upper = max(max(a, b), c);
            pool.client.primitives[0].at[mine] = 
                Primitive(lower, valid ? mine : kNoPrimitive, upper);
            precise vec3 center = lower + upper;
            if (valid) {
                boxes[0] = join(boxes[0], keys_of(lower, upper));
                boxes[1] = join(boxes[1], keys_of(center, center));
            }
        }
        valid_count += subgroupBallotBitCount(subgroupBallot(valid));
    }
    join_lanes(boxes);
    flush_boxes(0, boxes);
    if (subgroupElect()) pool.client.scratch.words[chunk_word(begin, end)] = valid_count;
    pool_spend(kChunkPrimitives / gl_SubgroupSize + kReduceIterations);
}

/// Moves the valid primitives of a chunk to the other side, from where the scanned counts say.
void compact_chunk(uint begin, uint end) {
    uint target = pool.client.scratch.words[chunk_word(begin, end)];
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = pool.client.primitives[0].at[min(mine, end - 1)];
        const bool valid = mine < end && primitive.id != kNoPrimitive;
        const uvec4 ballot = subgroupBallot(valid);
        if (valid)
            pool.client.primitives[1].at[target + subgroupBallotExclusiveBitCount(ballot)] = primitive;
        target += subgroupBallotBitCount(ballot);
    }
    pool_spend(kChunkPrimitives / gl_SubgroupSize);
}
