// What a cluster is to the light: make_element() of metric.cpp in single precision. The includer
// defines kDirectional and kCapsules and includes metric.glsl.
//
// With e = 2^-24: directions err by a few e, and so do places across a directional light, where
// coordinates are below 2. A distance from the origin errs by 8 e of itself. An angular radius of at
// most 60 degrees errs by 10 e through that and by 4 e through arc_tangent; it is widened by
// kMetricError, 64 e, a quarter of which is the query's own.

const uint kRoleElement = 0, kRoleSpecial = 1, kRoleFacesAway = 2;

/// sin(60 degrees) is 0.866: what looks wider is special, and a little of what does not.
const float kWidestSine = 0.866;
/// Share of a distance from the light, 36 e: its error, that of a query's depth, and room.
const float kDepthError = 2.1457672e-6;

/// From the origin to the segment ab: from its nearer end, along which distances that cancel are
/// no longer than that.
float distance_to_segment(vec3 a, vec3 b) {
    if (!kCapsules) return length(a);
    const bool swapped = dot(b, b) < dot(a, a);
    const vec3 start = swapped ? b : a, e = swapped ? a - b : b - a;
    const float ee = dot(e, e);
    const float t = ee > 0 ? clamp(-dot(start, e) / ee, 0.0, 1.0) : 0.0;
    return length(start + t * e);
}

vec3 place_across(LightFrame frame, vec3 p) {
    return vec3(dot(frame.right, p), dot(frame.up, p), 0);
}

float angle_between(vec3 p, vec3 q) { return arc_tangent(length(cross(p, q)), dot(p, q)); }

/// Whether all normals of the cluster are less than 90 degrees from all ways that light takes to
/// it; see metric.cpp.
bool all_face_away(LightFrame frame, Cluster cluster, Element element) {
    const float cosine = cluster.cone_cosine;
    if (!(cosine > 0)) return false;
    float light;
    if (kDirectional)
        light = angle_between(cluster.axis, frame.forward);
    else
        light = element.radius + max(angle_between(cluster.axis, element.a),
                                     angle_between(cluster.axis, element.b));
    const float cone = arc_tangent(sqrt(max(1 - cosine * cosine, 0.0)), cosine);
    // The root above is of a small difference: off by 2^-10 at most where it is 0.
    return light + cone < 0.5 * kPi - 1e-3;
}

/// `element` and `min_depth` are defined for kRoleElement alone.
uint make_element(LightFrame frame, Cluster cluster, bool cull_facing, out Element element,
                  out float min_depth) {
    const vec3 a = (cluster.a - frame.origin) * frame.scale;
    const vec3 b = (cluster.b - frame.origin) * frame.scale;
    const float radius = cluster.radius * frame.scale;
    if (kDirectional) {
        const float nearest = min(dot(frame.forward, a), dot(frame.forward, b)) + frame.start;
        min_depth = max(nearest - radius - kMetricError, 0.0);
        element = Element(place_across(frame, a), place_across(frame, b), radius + kMetricError);
    } else {
        const float away = distance_to_segment(a, b);
        min_depth = max(away - radius - kDepthError * away, 0.0);
        // Also where a coordinate is not finite.
        if (!(radius < kWidestSine * away) || !(dot(a, b) >= 0)) return kRoleSpecial;
        element.radius = kMetricError +
                         arc_tangent(radius, sqrt((away - radius) * (away + radius)));
        element.a = normalize(a);
        element.b = normalize(b);
    }
    return cull_facing && all_face_away(frame, cluster, element) ? kRoleFacesAway : kRoleElement;
}
