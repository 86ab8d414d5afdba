// The root's first phases: boxes of the triangles, bounds of the scene, and, only if there are
// degenerate triangles, closing the gaps they leave.

/// Exactly no area: the same arithmetic in the same order as TriangleMesh::degenerate.
bool degenerate(vec3 a, vec3 b, vec3 c) {
    precise dvec3 u = dvec3(b) - dvec3(a), v = dvec3(c) - dvec3(a);
    precise double x = u.y * v.z - v.y * u.z;
    precise double y = u.z * v.x - v.z * u.x;
    precise double z = u.x * v.y - v.x * u.y;
    return x == 0.0 && y == 0.0 && z == 0.0;
}

void setup_chunk(uint begin, uint end) {
    BuildInput mesh = pool.client.mesh.data;
    KeyBox boxes = empty_keys(), centers = empty_keys();
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
            store_primitive(0, mine, Primitive(lower, valid ? mine : kNoPrimitive, upper, 0));
            precise vec3 center = lower + upper;
            if (valid) {
                boxes = join(boxes, keys_of(lower, upper));
                centers = join(centers, keys_of(center, center));
            }
        }
        valid_count += subgroupBallotBitCount(subgroupBallot(valid));
    }
    store_rows(0, boxes);
    store_rows(kKeys, centers);
    max_rows(2 * kKeys);
    flush_rows(0, 2 * kKeys);
    if (subgroupElect()) pool.client.scratch.words[chunk_word(begin, end)] = valid_count;
    pool_spend(kChunkPrimitives / gl_SubgroupSize + 2 * gl_SubgroupSize);
}

/// Moves the valid primitives of a chunk to the other side, to where the scanned counts say.
void compact_chunk(uint begin, uint end) {
    uint target = pool.client.scratch.words[chunk_word(begin, end)];
    for (uint i = begin; i < end; i += gl_SubgroupSize) {
        const uint mine = i + gl_SubgroupInvocationID;
        const Primitive primitive = load_primitive(0, min(mine, end - 1));
        const bool valid = mine < end && primitive.id != kNoPrimitive;
        const uvec4 ballot = subgroupBallot(valid);
        if (valid) store_primitive(1, target + subgroupBallotExclusiveBitCount(ballot), primitive);
        target += subgroupBallotBitCount(ballot);
    }
    pool_spend(kChunkPrimitives / gl_SubgroupSize);
}
