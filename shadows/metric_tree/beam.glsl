// Walks a metric tree with a beam: the hook of shadows/beam/beam.glsl.
//
// The light sees a group of points within a cone (directional: a disc), which asks the tree like a point
// with a radius. Lanes take a node each off the stack. What clusters they find are tested against the
// beam's sides and against their slabs before their triangles are.
#include "shadows/metric_tree/shared_stack.glsl"

CornerTriangle beam_triangle(uint index) {
    return corner_triangle(push.structure.triangles, index);
}

/// Where the light sees a direction of the beam's frame, or a place in it.
vec3 seen_from_beam(LightFrame frame, vec3 q) {
    const vec3 p = from_beam(q);
    if (!kDirectional) return p;
    return vec3(dot(frame.right, p), dot(frame.up, p), 0);
}

/// What the group asks: its rectangle of u and v, which is convex, is within the farthest corner from its
/// middle.
Question question_of_group(LightFrame frame) {
    const vec2 middle = 0.5 * beam.lower + 0.5 * beam.upper;
    const float z = kDirectional ? 0.0 : 1.0;
    Question question;
    question.center = seen_from_beam(frame, vec3(middle, z));
    question.radius = 0;
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        const vec2 corner = vec2((i & 1) != 0 ? beam.lower.x : beam.upper.x,
                                 (i & 2) != 0 ? beam.lower.y : beam.upper.y);
        question.radius =
            max(question.radius,
                distance_between(question.center, seen_from_beam(frame, vec3(corner, z))));
    }
    question.radius += kMetricError + (kDirectional ? kRound * beam.reach : 0.0);
    if (kDirectional) {
        const vec3 forward = to_beam(frame.forward);
        const vec3 depth = max(forward * beam.points_lower, forward * beam.points_upper);
        question.depth = depth.x + depth.y + depth.z + frame.start + kRound * beam.reach;
    } else {
        const vec2 outermost = max(abs(beam.lower), abs(beam.upper));
        question.depth = beam.points_upper.z * length(vec3(outermost, 1)) * (1.0 + kRound);
    }
    return question;
}

/// Whether the cluster's ball or capsule may meet a segment of the group.
bool beam_meets_capsule(vec3 a, vec3 b, float radius) {
    const vec2 lower_reach = radius * sqrt(1.0 + beam.slope_lower * beam.slope_lower);
    const vec2 upper_reach = radius * sqrt(1.0 + beam.slope_upper * beam.slope_upper);
    const vec2 past_lower = max(a.xy - beam.slope_lower * a.z, b.xy - beam.slope_lower * b.z);
    const vec2 past_upper = min(a.xy - beam.slope_upper * a.z, b.xy - beam.slope_upper * b.z);
    return !(any(lessThan(past_lower + lower_reach, beam.offset_lower)) ||
             any(greaterThan(past_upper - upper_reach, beam.offset_upper)) ||
             any(lessThan(max(a, b) + radius, beam.hull_lower)) ||
             any(greaterThan(min(a, b) - radius, beam.hull_upper)));
}

/// Whether a segment of the group may pass between the planes of the slab, at depths z (in the beam's
/// frame) from `first` to `last`.
bool beam_meets_slab(Cluster cluster, float first, float last) {
    const vec3 axis = to_beam(cluster.axis);
    const vec2 across = range_of(vec3(axis.xy, kDirectional ? 0.0 : axis.z));
    const float along = dot(axis, vec3(beam.tilt, 1));
    const vec2 at_first = kDirectional ? across + along * first : across * first;
    const vec2 at_last = kDirectional ? across + along * last : across * last;
    const float base = dot(cluster.axis, beam_origin);
    const vec2 outermost = max(abs(beam.lower), abs(beam.upper));
    const float widest = outermost.x + outermost.y, deepest = max(abs(first), abs(last));
    const float error = kRound * (norm1(beam_origin) * beam_scale + beam.reach +
                                  (kDirectional ? widest + deepest * norm1(vec3(beam.tilt, 1))
                                                : deepest * (1.0 + widest)));
    const float low = min(at_first.x, at_last.x) - error, high = max(at_first.y, at_last.y) + error;
    return !(high < (cluster.slab_low - base) * beam_scale ||
             low > (cluster.slab_high - base) * beam_scale);
}

bool beam_meets_cluster(Cluster cluster) {
    const vec3 a = from_world(cluster.a), b = from_world(cluster.b);
    const float radius = cluster.radius * beam_scale +
                         kRound * (norm1(a) + norm1(b) + beam.reach);
    if (!beam_meets_capsule(a, b, radius)) return false;
    return !kUseSlabs || beam_meets_slab(cluster, max(min(a.z, b.z) - radius, beam.hull_lower.z),
                                         min(max(a.z, b.z) + radius, beam.hull_upper.z));
}

/// Tests `count` triangles from `first` on of each lane, packed into full batches.
void test_triangles_of_lanes(uint first, uint count) {
    const uint to_here = sum_to_here(count), before = to_here - count;
    const uint total = subgroupShuffle(to_here, kLanes - 1);
    if (total == 0 || !beam_take_triangles(total)) return;
    uint done = 0;
    while (true) {
        // The last lane whose triangles begin at or before this one.
        const uint mine = done + lane();
        uint from = 0;
        [[unroll]] for (uint k = 0; k < 7; ++k) {
            const uint apart = kLanes / 2 >> k;
            if (apart > 0 && subgroupShuffle(before, from + apart) <= mine) from += apart;
        }
        const uint index = subgroupShuffle(first, from) + mine - subgroupShuffle(before, from);
        beam_test_triangles(mine < total ? index : 0, mine < total);
        done += kLanes;
        if (done >= total || group_finished() || !beam_step(1)) break;
    }
}

void beam_walk() {
    const MetricHeader header = push.structure.header.header;
    const Question question = question_of_group(header.frame);
    stack_depth = 0;
    stack_push(header.special != 0 && lane() == 0, header.special);
    stack_push(header.root != 0 && lane() == 0, header.root);
    if (stack_depth == 0) return;
    while (true) {
        beam_nodes += min(stack_depth, kLanes);
        const uint link = stack_pop(kLanes);
        Answer answer = Answer(false, false, false, false, false);
        uint near = 0, far = 0, over = 0;
        uint first = 0, count = 0;
        if (link != 0) {
            const MetricNode node = metric_node(push.structure.nodes, node_of(link));
            answer = ask(question, node, kUseDepth, kUseInterval);
            near = node.near;
            far = node.far;
            over = node.over;
            if (answer.own) {
                const Cluster cluster = cluster_at(push.structure.clusters, node_of(link));
                if (beam_meets_cluster(cluster)) {
                    first = cluster.first;
                    count = cluster.count;
                }
            }
        }
        if (!stack_push(answer.over, over) || !stack_push(answer.far, far) ||
            !stack_push(answer.near, near)) {
            beam_end = kBeamStackFull;
            break;
        }
        test_triangles_of_lanes(first, count);
        if (stack_depth == 0 || group_finished() || beam_end != kBeamFinished || !beam_step(1)) break;
    }
}
