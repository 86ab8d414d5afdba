// What single precision cannot decide: the second half of occlusion.glsl.
//
// Whether a segment crosses a triangle is a matter of five signs: on which side of the triangle's
// plane its ends lie, and on which side of the three planes through p, the light and an edge the
// third corner lies. All are signs of a determinant det[q - x, y - x, z - x] of four input points.
//
// In double precision first. Each of the six products of three differences that make it up carries
// at most eight roundings by 2^-53 into the result: three differences, two products, the difference
// of the cross product, two sums. So it is off by less than 8.1 * 2^-53 times the sum of the
// products' sizes, computed in the same way; the bound below is twice that. Differences are 0 or
// between 2^-149 and 2^129 in size: nothing underflows or overflows, and a bound of 0 means a 0.
//
// Else exactly, as a sum of products of three inputs each,
//     q . (x x y + y x z + z x x) - z . (x x y).
// A product of two inputs is exact in double precision; cut into halves of 26 bits (Veltkamp), each
// half times the third is exact as well. The 48 terms are added without error by two-sums (Knuth):
// what one loses goes to the next. All numbers are below 2^389 and multiples of 2^-447. A sum below
// 2^m loses at most 2^(m - 54) per term, so the next stays below 2^(m - 48), and the eighteenth,
// below 2^(389 - 17 * 48), loses nothing. In the end they are made into an expansion whose parts do
// not overlap, so that the largest has the sign of all (Shewchuk 1997, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates", theorem 10, Grow-Expansion).
// The two-sum needs doubles that are rounded to nearest, and `precise`, lest compilers cancel its
// terms. Sums are indexed by constants alone, so that they need no memory that all paths pay for.
#ifndef SHADOWS_EXACT_OCCLUSION_GLSL
#define SHADOWS_EXACT_OCCLUSION_GLSL

// Of this invocation so far, for those who want to know; costs nothing if nobody does.
uint double_decisions = 0;  // segments and triangles that came here
uint exact_decisions = 0;   // those that needed error-free sums
uint exact_loops = 0;       // loop iterations that this took

// Those since the last call, for walks whose loops are counted.
uint take_exact_loops() {
    const uint loops = exact_loops;
    exact_loops = 0;
    return loops;
}

const int kUnsure = 2;

// Side of q, or of the direction q if `w` is 0, of the plane through x, y, z: the sign of
// det[q - w x, y - x, z - x], or kUnsure.
int side_in_double(vec3 q, float w, vec3 x, vec3 y, vec3 z) {
    precise dvec3 e = dvec3(y) - dvec3(x);
    precise dvec3 f = dvec3(z) - dvec3(x);
    precise dvec3 g = dvec3(q) - dvec3(w * x);
    precise dvec3 left = e.yzx * f.zxy, right = e.zxy * f.yzx;
    precise dvec3 normal = left - right, length = abs(left) + abs(right);
    precise double value = g.x * normal.x + g.y * normal.y + g.z * normal.z;
    precise double size = abs(g.x) * length.x + abs(g.y) * length.y + abs(g.z) * length.z;
    precise double error = size * 1.7763568394002505e-15LF;  // 2^-49
    if (value > error) return 1;
    if (value < -error) return -1;
    return error > 0.0LF ? kUnsure : 0;
}

// The larger part of a + b replaces `a`, the smaller one `b`.
void two_sum(inout double a, inout double b) {
    precise double sum = a + b;
    precise double grown = sum - a;
    precise double lost = (a - (sum - grown)) + (b - grown);
    a = sum;
    b = lost;
}

const uint kSums = 18, kUsualSums = 4;
double sums[kSums];

void add_to_sums(double term) {
    [[unroll]] for (uint i = 0; i < kUsualSums; ++i) two_sum(sums[i], term);
    if (term != 0.0LF) {
        [[unroll]] for (uint i = kUsualSums; i < kSums; ++i) two_sum(sums[i], term);
    }
}

int sign_of_sums() {
    double parts[kSums];
    [[unroll]] for (uint i = 0; i < kSums; ++i) {
        parts[i] = sums[i];
        [[unroll]] for (uint k = 0; k < i; ++k) two_sum(parts[i], parts[k]);
    }
    int sign = 0;
    [[unroll]] for (uint i = 0; i < kSums; ++i)
        sign = parts[i] > 0.0LF ? 1 : parts[i] < 0.0LF ? -1 : sign;
    return sign;
}

void add_product(float x, float y, float z) {
    precise double product = double(x) * double(y);
    precise double scaled = product * 134217729.0LF;
    precise double high = scaled - (scaled - product);
    precise double low = product - high;
    precise double high_term = high * double(z), low_term = low * double(z);
    add_to_sums(high_term);
    add_to_sums(low_term);
}

int side_exactly(vec3 q, float w, vec3 x, vec3 y, vec3 z) {
    [[unroll]] for (uint i = 0; i < kSums; ++i) sums[i] = 0.0LF;
    exact_loops += 17;
    // d . (x x y): with d = q for each of the three pairs, then with d = -w z.
    for (uint pair = 0; pair < 4; ++pair) {
        vec3 d = pair < 3 ? q : -w * z;
        for (uint axis = 0; axis < 3; ++axis) {
            add_product(x.y, y.z, d.x);
            add_product(-x.z, y.y, d.x);
            d = d.yzx;
            x = x.yzx;
            y = y.yzx;
        }
        const vec3 first = x;
        x = y;
        y = z;
        z = first;
    }
    return sign_of_sums();
}

// Whether these sides rule a crossing out; kUnsure rules out nothing.
bool misses(int receiver, int light, int ab, int bc, int ca) {
    const bool below = ab == -1 || bc == -1 || ca == -1, above = ab == 1 || bc == 1 || ca == 1;
    return (below && above) || receiver == 0 || light == 0 ||
           (receiver == light && receiver != kUnsure);
}

// 1, 0, or kUnsure if double precision does not tell.
int occludes_in_double(Segment s, vec3 a, vec3 b, vec3 c) {
    ++double_decisions;
    const float w = s.directional ? 0.0 : 1.0;
    const int receiver = side_in_double(s.origin, 1.0, a, b, c);
    const int light = side_in_double(s.target, w, a, b, c);
    const int ab = side_in_double(s.target, w, s.origin, b, a);
    const int bc = side_in_double(s.target, w, s.origin, c, b);
    const int ca = side_in_double(s.target, w, s.origin, a, c);
    if (misses(receiver, light, ab, bc, ca)) return 0;
    const bool unsure = receiver == kUnsure || light == kUnsure || ab == kUnsure ||
                        bc == kUnsure || ca == kUnsure;
    return unsure ? kUnsure : 1;
}

bool occludes_exactly(Segment s, vec3 a, vec3 b, vec3 c) {
    ++exact_decisions;
    const float w = s.directional ? 0.0 : 1.0;
    int sides[5];
    for (uint i = 0; i < 5; ++i) {
        const vec3 x = i < 2 ? a : s.origin;
        const vec3 y = i < 3 ? b : i == 3 ? c : a;
        const vec3 z = i < 2 ? c : i == 2 ? a : i == 3 ? b : c;
        const int side = side_exactly(i == 0 ? s.origin : s.target, i == 0 ? 1.0 : w, x, y, z);
        [[unroll]] for (uint k = 0; k < 5; ++k) sides[k] = k == i ? side : sides[k];
    }
    return !misses(sides[0], sides[1], sides[2], sides[3], sides[4]);
}

#endif
