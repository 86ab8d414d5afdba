// Insertion of elements into a ternary metric tree, by all lanes at once. F. Deves et al., "Scalable
// Real-Time Shadows using Clustering and Metric Trees", 2018, section 5.3.
//
// The root task owns the places of a permutation of the clusters. Trees of sorted elements are deep, but
// a random order finds nothing in the caches; so the order is random in the large and sorted in the
// small (N. Amenta, S. Choi and G. Rote, "Incremental Constructions con BRIO", 2003).
//
// A lane takes an element down from the root: at each node it widens the bounds that speak of the
// element, takes one of three links, and where there is none, puts its own node there by one
// compare-and-swap; who loses goes on from the winner. Nothing is locked, and validity depends on no
// order: nodes' arcs were written by an earlier dispatch, all else are words that change by commuting
// atomics.
//
// A node's delta decides where elements go: near if all of it is within delta of the node's arc, far
// if nothing is, else overlapping. It halves on every near link, so it belongs to the way to a node
// and travels in the link: delta = frame.delta / 2^k, with k in the bits above kLinkMask. Queries
// rely on the bounds alone.
//
// Where delta is below the radius of the elements, as with copies of one, all of them overlap, and
// paths would become as long as there are elements. From depth kMaxDepth on they are put in a list
// instead, by one exchange, whose bounds hold everything.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "taskpool/pool/pool_types.glsl"
#include "structures/metric_tree/metric_tree_shared.h"

layout(constant_id = 16) const bool kDirectional = false;
layout(constant_id = 17) const bool kCapsules = true;
#include "structures/metric_tree/metric.glsl"

struct Task { uint places; };  // a power of two, no less than there are clusters

pool_buffer(16) Nodes { MetricNode at[]; };
pool_buffer(4) Header { MetricHeader header; };

struct Client {
    Nodes nodes;
    Header header;
    uint cluster_count;
    uint chunk_places;
    uint seed;
    float delta;  // of the frame
};
#include "taskpool/pool/pool.glsl"

// ---- Words of a node that change ------------------------------------------------------------------
// Floats are compared as integers: those that are not negative order alike, and -1 is below them.

const uint kNearMax = 7, kLinks = 8, kMinDepth = 12, kOverMin = 13, kOverMax = 14, kFarMin = 15;
const uint kRootOffset = 64;  // bytes, in the header

uint64_t word_address(uint node, uint word) {
    return uint64_t(pool.client.nodes) + uint64_t(node) * 64 + word * 4;
}

int peek(PoolInts words) {
    return atomicLoad(words.at[0], gl_ScopeDevice, gl_StorageSemanticsNone, gl_SemanticsRelaxed);
}
void lower(uint node, uint word, float value) {
    PoolInts words = PoolInts(word_address(node, word));
    if (peek(words) > floatBitsToInt(value)) atomicMin(words.at[0], floatBitsToInt(value));
}
void raise(uint node, uint word, float value) {
    PoolInts words = PoolInts(word_address(node, word));
    if (peek(words) < floatBitsToInt(value)) atomicMax(words.at[0], floatBitsToInt(value));
}

/// The link at `address`; `own` is put there, and 0 returned, if there is none.
uint follow(uint64_t address, uint own) {
    PoolUints words = PoolUints(address);
    const uint link = uint(peek(PoolInts(address)));
    return link == 0 ? atomicCompSwap(words.at[0], 0, own) : link;
}

// ---- One element ----------------------------------------------------------------------------------

const uint kNear = 0, kFar = 1, kOverlap = 2;  // links in their order
const uint kHalvingShift = 27;                 // above the bits of kLinkMask

struct Insertion {
    Element element;
    uint id;
    float min_depth;
    uint link;      // to where it is now, with its k; 0: it has found its place
    uint ancestor;  // link to the node whose overlapping subtree that is in
    uint depth;     // nodes passed
};

/// Which cluster comes at `place`, a permutation. In rounds of doubling size: each takes one cluster
/// out of every so many, by chance which, nearly in their order.
uint cluster_at(uint place, uint places) {
    const uint mask = places - 1, bits = uint(findMSB(places)), round = uint(findMSB(place | 1));
    const uint spaced = place == 0 ? 0 : (2 * (place - (1u << round)) + 1) << (bits - round) >> 1;
    // Each bit is flipped or not by a hash of the higher ones: S. Laine and T. Karras, "Stratified
    // Sampling for Stochastic Transparency", 2011, section 3.1.
    uint x = (bitfieldReverse(spaced) >> (32 - bits)) + pool.client.seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return (bitfieldReverse(x) >> (32 - bits)) & mask;
}

/// The element of place `place`, at the root. False if it is none.
bool begin(uint place, uint places, inout Insertion insertion) {
    const uint id = cluster_at(place, places);
    if (id >= pool.client.cluster_count) return false;
    const MetricNode node = pool.client.nodes.at[id];
    if (node.radius < 0 || isinf(node.radius)) return false;
    insertion = Insertion(Element(node.a, node.b, node.radius), id, node.min_depth, 0, 0, 0);
    insertion.link = follow(uint64_t(pool.client.header) + kRootOffset, id + 1);
    return true;
}

/// Puts the element at the front of the list that begins at `node`.
void push_on_list(uint node, Insertion insertion) {
    const uint id = insertion.id;
    pool.client.nodes.at[id].ancestor = node + 1;
    pool.client.nodes.at[id].min_depth = 0;
    pool.client.nodes.at[id].over_min = 0;
    pool.client.nodes.at[id].over_max = uintBitsToFloat(0x7f800000u);
    const uint next =
        atomicExchange(PoolUints(word_address(node, kLinks + kOverlap)).at[0], id + 1,
                       gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquireRelease);
    pool.client.nodes.at[id].over = next;
    if (next != 0) pool.client.nodes.at[(next & kLinkMask) - 1].ancestor = id + 1;
}

/// Takes the element past one node.
void descend(inout Insertion insertion) {
    const uint node = (insertion.link & kLinkMask) - 1;
    uint halvings = insertion.link >> kHalvingShift;
    const vec3 a = pool.client.nodes.at[node].a, b = pool.client.nodes.at[node].b;
    lower(node, kMinDepth, insertion.min_depth);
    ++insertion.depth;

    float middle;
    const vec2 reach = reach_of(Element(a, b, 0), insertion.element, middle);
    const float delta = ldexp(pool.client.delta, -int(halvings));
    const bool full = insertion.depth >= kMaxDepth;
    const uint side = full ? kOverlap : reach.y <= delta ? kNear : reach.x > delta ? kFar : kOverlap;
    if (side != kNear) lower(node, side == kFar ? kFarMin : kOverMin, reach.x);
    if (side != kFar) raise(node, side == kNear ? kNearMax : kOverMax, reach.y);
    if (full) {
        push_on_list(node, insertion);
        insertion.link = 0;
        return;
    }
    if (side == kNear) halvings = min(halvings + 1, 31);
    if (side == kOverlap) insertion.ancestor = node + 1;
    insertion.link =
        follow(word_address(node, kLinks + side), (insertion.id + 1) | (halvings << kHalvingShift));
    if (insertion.link == 0) pool.client.nodes.at[insertion.id].ancestor = insertion.ancestor;
}

// ---- Hooks ----------------------------------------------------------------------------------------

void run_chunk(inout Task task, uint phase, uint step, uint chunk) {
    const uint first = chunk * pool.client.chunk_places;
    const uint end = min(first + pool.client.chunk_places, task.places);
    uint turns = 0, inserted = 0, bucketed = 0, depth_max = 0;
    // All lanes take their next together: they are near each other, and go the same ways.
    for (uint lot = first; lot < end; lot += gl_SubgroupSize) {
        const uint place = lot + gl_SubgroupInvocationID;
        Insertion insertion;
        insertion.depth = 0;
        if (place < end && begin(place, task.places, insertion)) {
            while (insertion.link != 0) descend(insertion);
            ++inserted;
            if (insertion.depth >= kMaxDepth) ++bucketed;
            depth_max = max(depth_max, min(insertion.depth + 1, kMaxDepth));
        }
        turns += 1 + subgroupMax(insertion.depth);
    }
    pool_spend(turns);
    pool_progress(end - first);
    inserted = subgroupAdd(inserted);
    bucketed = subgroupAdd(bucketed);
    depth_max = subgroupMax(depth_max);
    if (subgroupElect()) {
        atomicAdd(pool.client.header.header.inserted, inserted);
        if (bucketed > 0) atomicAdd(pool.client.header.header.bucketed, bucketed);
        atomicMax(pool.client.header.header.depth_max, depth_max);
    }
}
Next finish_step(inout Task task, uint phase, uint step) { return next_end(); }
Task spawn_child(Task parent, uint child, out Start start) {
    start = Start(0, 0, 0, 0);
    return parent;
}
void spawned(Task parent, uint child, uint slot) {}
void end_task(Task task) {}
