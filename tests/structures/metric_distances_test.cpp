// Distances, frames and elements against dense sampling, and metric.glsl against metric.hpp.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "taskpool/gpu/recorder.hpp"
#include "tests/structures/metric_pairs.hpp"
#include "tests/support/gpu_fixture.hpp"

std::span<const taskpool::gpu::Shader> tests_structures_metric_distances_shaders();

namespace {

using namespace structures::metric_tree;
using tests::Aabb;
using tests::ElementPair;
using tests::Light;
using tests::Random;

glm::dvec3 along(const Element& element, bool directional, double t) {
    const glm::dvec3 p = glm::mix(element.a, element.b, t);
    return directional ? p : glm::normalize(p);
}

class Metric : public testing::TestWithParam<bool> {};

TEST_P(Metric, DistanceIsThatToTheNearestOfManyPoints) {
    const bool directional = GetParam();
    for (const ElementPair& pair : tests::element_pairs(700, directional, 1)) {
        const glm::dvec3 p = pair.element.a;
        constexpr int kSteps = 2000;
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i <= kSteps; ++i)
            nearest = std::min(
                nearest, distance_between(directional, p,
                                          along(pair.pivot, directional, double(i) / kSteps)));
        const double d = distance_to(directional, p, pair.pivot);
        const double step = distance_between(directional, pair.pivot.a, pair.pivot.b) / kSteps;
        EXPECT_LE(d, nearest + 1e-12);
        EXPECT_GE(d, nearest - step - 1e-12);
    }
}

TEST_P(Metric, ReachHoldsEveryPointOfTheElement) {
    const bool directional = GetParam();
    Random random(3);
    double loosest = 0;
    for (const ElementPair& pair : tests::element_pairs(100'000, directional, 2)) {
        const Reach reach = reach_of(directional, pair.pivot, pair.element);
        EXPECT_NEAR(reach.middle,
                    distance_to(directional, along(pair.element, directional, 0.5), pair.pivot),
                    1e-6);
        double low = std::numeric_limits<double>::infinity(), high = 0;
        for (int i = 0; i < 20; ++i) {
            const double t = i < 4 ? i & 1 : random.uniform(0, 1);
            const glm::dvec3 p = tests::step(
                random, directional, along(pair.element, directional, t), pair.element.radius);
            const double d = distance_to(directional, p, pair.pivot);
            low = std::min(low, d);
            high = std::max(high, d);
        }
        // The ends' rounding makes an arc's middle a little off.
        EXPECT_LE(high + 0.9 * kMetricError, reach.high);
        EXPECT_GE(low - 0.9 * kMetricError, reach.low - (reach.low > 0 ? 0 : kMetricError));
        loosest = std::max(loosest, reach.high - high);
    }
    RecordProperty("loosest", std::to_string(loosest));
}

INSTANTIATE_TEST_SUITE_P(Lights, Metric, testing::Bool());

LightFrame random_frame(Random& random, bool directional, const Aabb& box) {
    const glm::dvec3 v =
        directional ? random.direction() * std::pow(10, random.uniform(-6, 6)) : random.in_box(1.3);
    return make_frame({directional ? Light::Type::directional : Light::Type::point, v}, box);
}

TEST(Frames, FitTheirBox) {
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const bool directional = i % 2 == 0;
        const double size = std::pow(10, random.uniform(-6, 6));
        Aabb box;
        for (int k = 0; k < 3; ++k) box.grow(random.in_box(size));
        const Light light{directional ? Light::Type::directional : Light::Type::point,
                          random.in_box(3 * size)};
        const LightFrame frame = make_frame(light, box);
        EXPECT_EQ(frame.directional, directional ? 1u : 0u);
        double most = 0;
        const glm::dvec3 middle = seen(frame, box.center());
        for (int k = 0; k < 30; ++k) {
            const auto pick = [&](int axis) {
                return k < 8 ? (k >> axis & 1 ? box.upper : box.lower)[axis]
                             : float(random.uniform(box.lower[axis], box.upper[axis]));
            };
            const glm::dvec3 p(pick(0), pick(1), pick(2));
            const glm::dvec3 offset = glm::abs(p - glm::dvec3(frame.origin)) * double{frame.scale};
            most = std::max({most, offset.x, offset.y, offset.z});
            EXPECT_GE(depth_of(frame, p), directional ? 0.125 : 0);
            EXPECT_LE(glm::length(seen(frame, p)), directional ? 3.5 : 4);
            EXPECT_LE(distance_between(directional, seen(frame, p), middle),
                      frame.delta * (1 + 1e-6) + 1e-6);
        }
        EXPECT_GE(most, 0.999);
        EXPECT_LT(most, 2.001);
    }
    EXPECT_EQ(make_frame({Light::Type::point, {1, 2, 3}}, Aabb{}).scale, 1);
    EXPECT_EQ(make_frame({Light::Type::directional, {1, 2, 3}}, Aabb{}).scale, 1);
    EXPECT_THROW(make_frame({Light::Type::directional, {0, 0, 0}}, Aabb{}), std::invalid_argument);
}

TEST(Frames, LightTravelsIntoDepthAndNotAcross) {
    Random random(5);
    Aabb box;
    box.grow(glm::vec3(-1));
    box.grow(glm::vec3(1));
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 way = random.direction() * std::pow(10, random.uniform(-3, 3));
        const LightFrame frame = make_frame({Light::Type::directional, way}, box);
        const glm::dvec3 p = random.in_box(1), q = p + glm::normalize(glm::dvec3(way));
        EXPECT_NEAR(glm::length(seen(frame, p) - seen(frame, q)), 0, 1e-6);
        EXPECT_NEAR(depth_of(frame, q) - depth_of(frame, p), frame.scale, 1e-6);
        const glm::dvec3 r = random.in_box(1), way_p = seen(frame, p) - seen(frame, r);
        const double depth = depth_of(frame, p) - depth_of(frame, r);
        EXPECT_NEAR(std::sqrt(glm::dot(way_p, way_p) + depth * depth),
                    glm::length(p - r) * frame.scale, 1e-5);
    }
}

TEST(Elements, HoldAllPointsOfTheirClusters) {
    Random random(6);
    Aabb box;
    box.grow(glm::vec3(-2));
    box.grow(glm::vec3(2));
    int elements = 0, special = 0, away = 0;
    for (int i = 0; i < 20'000; ++i) {
        const bool directional = i % 2 == 0;
        const LightFrame frame = random_frame(random, directional, box);
        const glm::dvec3 a = random.in_box(1);
        const glm::dvec3 b = i % 3 == 0 ? a : a + random.in_box(1) * random.uniform(0, 1);
        Cluster cluster = tests::make_cluster(a, b, std::pow(10, -random.uniform(0.3, 5)));
        cluster.axis = random.direction();
        cluster.cone_cosine = float(std::cos(random.uniform(0, 1.4)));
        Element element;
        double min_depth;
        const Role role = make_element(frame, cluster, true, element, min_depth);
        elements += role == Role::element;
        special += role == Role::special;
        away += role == Role::faces_away;
        if (role == Role::special) continue;
        for (int k = 0; k < 30; ++k) {
            const glm::dvec3 p =
                glm::mix(glm::dvec3(cluster.a), glm::dvec3(cluster.b),
                         k < 4 ? k & 1 : random.uniform(0, 1)) +
                (k % 2 == 0 ? random.direction() : random.in_ball()) * double{cluster.radius};
            EXPECT_LE(distance_to(directional, seen(frame, p), element) + 0.99 * kMetricError,
                      element.radius);
            EXPECT_GE(depth_of(frame, p), min_depth);
            const glm::dvec3 normal =
                tests::step(random, false, glm::normalize(glm::dvec3(cluster.axis)),
                            std::acos(double{cluster.cone_cosine}));
            const glm::dvec3 travels =
                directional ? glm::dvec3(frame.forward) : p - glm::dvec3(frame.origin);
            if (role == Role::faces_away) {
                EXPECT_GT(glm::dot(normal, travels), 0);
            }
        }
    }
    EXPECT_GT(elements, 5000);
    EXPECT_GT(special, 30);
    EXPECT_GT(away, 2000);
}

TEST(Elements, RolesOfClustersAroundTheLight) {
    Aabb box;
    box.grow(glm::vec3(-2));
    box.grow(glm::vec3(2));
    const LightFrame frame = make_frame({Light::Type::point, {0, 0, 0}}, box);
    const auto role = [&](glm::dvec3 a, glm::dvec3 b, double radius) {
        Element element;
        double min_depth;
        const Role is =
            make_element(frame, tests::make_cluster(a, b, radius), true, element, min_depth);
        EXPECT_GE(min_depth, 0);
        return is;
    };
    EXPECT_EQ(role({0, 0, 1}, {0, 0, 1}, 0.5), Role::element);
    EXPECT_EQ(role({0, 0, 1}, {0, 0, 1}, 0.9), Role::special);            // wide
    EXPECT_EQ(role({0, 0, 1}, {0, 0, 1}, 1), Role::special);              // touched
    EXPECT_EQ(role({0, 0, 1}, {0, 0, 1}, 1.5), Role::special);            // around
    EXPECT_EQ(role({0, 0, 0}, {0, 0, 0}, 0), Role::special);              // the light itself
    EXPECT_EQ(role({-1, 0, 0}, {1, 0, 0}, 0.1), Role::special);           // its axis
    EXPECT_EQ(role({-10, -.05, 0}, {10, -.05, 0}, 0.01), Role::special);  // a long arc
    EXPECT_EQ(role({0, 0, 1}, {0, 0, 9}, 0.1), Role::element);            // on one ray
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(role({0, nan, 1}, {0, 0, 9}, 0.1), Role::special);
}

/// As the shader holds them.
struct DeviceElement {
    glm::vec3 a, b;
    float radius;
};
struct DevicePair {
    DeviceElement pivot, element;
};
struct DeviceAnswer {
    float at_a, low, high, middle;
};
struct DevicePush {
    std::uint64_t pairs, answers;
    std::uint32_t count;
};

class DeviceMetric : public tests::GpuTest, public testing::WithParamInterface<bool> {};

TEST_P(DeviceMetric, IsTheHostsToWithinItsError) {
    using namespace taskpool::gpu;
    const bool directional = GetParam();
    const auto pairs = tests::element_pairs(1'000'000, directional, 8);
    std::vector<DevicePair> input;
    const auto packed = [](const Element& e) {
        return DeviceElement{e.a, e.b, static_cast<float>(e.radius)};
    };
    for (const ElementPair& pair : pairs)
        input.push_back({packed(pair.pivot), packed(pair.element)});
    Device& device = tests::device();
    const Kernel kernel(device,
                        find_shader(tests_structures_metric_distances_shaders(),
                                    "tests/structures/metric_distances.comp"),
                        {{1, directional}});
    const Buffer source = make_buffer<DevicePair>(device, input, "pairs");
    const Buffer target(device, input.size() * sizeof(DeviceAnswer), "answers");
    Recorder recorder(device);
    recorder.dispatch(
        kernel,
        DevicePush{source.address(), target.address(), static_cast<std::uint32_t>(input.size())},
        1024);
    recorder.barrier();
    device.run(recorder);
    const auto answers = read<DeviceAnswer>(target, input.size());
    double distance_error = 0, reach_error = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto& [pivot, element] = pairs[i];
        const Reach reach = reach_of(directional, pivot, element);
        const double at_a = std::abs(answers[i].at_a - distance_to(directional, element.a, pivot));
        const double middle = std::abs(answers[i].middle - reach.middle);
        const double low = std::abs(answers[i].low - reach.low);
        const double high = std::abs(answers[i].high - reach.high);
        ASSERT_LT(at_a, 0.25 * kMetricError) << i;
        ASSERT_LT(middle, 0.25 * kMetricError) << i;
        ASSERT_LT(std::max(low, high), 0.75 * kMetricError) << i;
        distance_error = std::max({distance_error, at_a, middle});
        reach_error = std::max({reach_error, low, high});
    }
    RecordProperty("distance_error", std::to_string(distance_error / kMetricError));
    RecordProperty("reach_error", std::to_string(reach_error / kMetricError));
}

INSTANTIATE_TEST_SUITE_P(Lights, DeviceMetric, testing::Bool());

}  // namespace
