// Nearest point of a ball tree; one query per lane, no subgroup operation, so usable anywhere.
//
//     #include "taskpool/gpu/device.glsl"
//     #include "structures/ball_tree/query.glsl"
//     Nearest nearest = ball_tree_nearest(tree, position);
#include "structures/ball_tree/ball_tree_shared.h"

scalar_buffer(4) BallNodes { BallNode at[]; };
scalar_buffer(4) BallPoints { BallPoint at[]; };

struct BallTree {
    BallNodes nodes;
    BallPoints points;
    uint leaf_size;  // of the build
};

float ball_distance_squared(vec3 a, vec3 b) {
    precise vec3 d = a - b;
    precise float sum = d.x * d.x + d.y * d.y + d.z * d.z;
    return sum;
}

/// False only if no point of the ball can be nearer than `distance_squared`, all roundings considered:
/// a distance computed in floats is off by less than 12 * 2^-24 of itself (three differences, squares,
/// two sums, and a root of up to 4.5 ulp), or by less than 10^-18 where squares underflow.
bool ball_may_hold_nearer(BallNode ball, vec3 query, float distance_squared) {
    const float kSlack = 1e-6, kUnderflow = 1e-18;
    const float to_center = sqrt(ball_distance_squared(query, ball.center)) * (1 - kSlack);
    const float reach = (sqrt(ball.radius_squared) + sqrt(distance_squared)) * (1 + 2 * kSlack);
    return !(to_center > reach + kUnderflow);  // true if they overflowed
}

/// The point nearest to `query`, by its squared distance in floats; any one of several.
Nearest ball_tree_nearest(BallTree tree, vec3 query) {
    Nearest best = Nearest(kNoPoint, uintBitsToFloat(0x7f800000u));
    const BallNode root = tree.nodes.at[0];
    if (root.count == 0 && root.first == 0) return best;
    uint waiting[kMaxDepth];  // far children
    uint waiting_count = 0;
    uint id = 0;
    while (true) {
        const BallNode node = tree.nodes.at[id];
        if (ball_may_hold_nearer(node, query, best.distance_squared)) {
            if (node.count == 0) {
                const float left = ball_distance_squared(query, tree.nodes.at[node.first].center);
                const float right = ball_distance_squared(query, tree.nodes.at[node.first + 1].center);
                const uint far = right < left ? 0 : 1;
                waiting[waiting_count++] = node.first + far;
                id = node.first + 1 - far;
                continue;
            }
            // More points than a leaf may have are copies of one.
            const uint end = node.first + (node.count > tree.leaf_size ? 1 : node.count);
            for (uint i = node.first; i < end; ++i) {
                const BallPoint point = tree.points.at[i];
                const float d = ball_distance_squared(query, point.position);
                if (d < best.distance_squared || best.id == kNoPoint) best = Nearest(point.id, d);
            }
        }
        if (waiting_count == 0) return best;
        id = waiting[--waiting_count];
    }
}
