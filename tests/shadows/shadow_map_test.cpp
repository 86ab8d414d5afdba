// The shadow map: right away from silhouettes, better with resolution, its biases do what they
// say, faces meet without seams, and no input breaks it.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "shadows/method.hpp"
#include "shadows/shadow_map/map.hpp"
#include "shadows/truth/truth.hpp"
#include "tests/shadows/shadow_map_support.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace shadows;
using namespace tests::shadow_map;
using shadows::shadow_map::BiasMode;
using shadows::shadow_map::MapConfig;
using shadows::shadow_map::ShadowMap;
using shadows::shadow_map::usual_bias;
using structures::Settings;
using testing::HasSubstr;
using testing::ThrowsMessage;
using tests::add_box;
using ShadowMapTest = tests::GpuTest;

struct Answer {
    Visibility visible;
    std::uint32_t faces;
    std::size_t memory_bytes;
};

Answer ask(const Scene& scene, const MapConfig& config = {}) {
    ShadowMap map(tests::device(), config);
    map.load(scene.mesh);
    EXPECT_GE(map.render(scene.light), 0);
    const Points points(tests::device(), scene.points, kSide, kSide);
    Visibility visible;
    EXPECT_GE(map.look_up(points, visible), 0);
    EXPECT_EQ(visible.words.size(), points.count() / 32);
    return {visible, map.faces(), map.memory_bytes()};
}

/// Points on geometry, or free, that the method finds in shadow.
std::size_t shadowed(const Scene& scene, const Answer& answer) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < scene.points.x.size(); ++i) count += !answer.visible.lit(i);
    return count;
}

/// Certain points answered wrongly.
std::size_t wrong(const Scene& scene, const Answer& answer) {
    const truth::Verdicts verdicts = truth::Truth(scene.mesh, scene.light).judge(scene.points, {});
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < scene.points.x.size(); ++i) {
        const truth::Verdict verdict = verdicts.points[i];
        count += verdict.certain() && answer.visible.lit(i) == verdict.shadowed();
    }
    return count;
}

/// No point that is clear of edges is answered wrongly, in any of these ways, and there are many.
void expect_right_when_clear(const Scene& scene, const std::vector<MapConfig>& configs,
                             double least_part_clear = 0.2) {
    const std::uint32_t resolution = configs[0].resolution;
    std::vector<std::uint32_t> clear_lit, clear_dark;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < scene.points.x.size(); ++i) {
        if (scene.points.primitive[i] == kNoPrimitive) continue;
        ++count;
        bool lit = false;
        if (clear_of_edges(scene, i, resolution, 1.5f, lit))
            (lit ? clear_lit : clear_dark).push_back(i);
    }
    EXPECT_GT(double(clear_lit.size() + clear_dark.size()), least_part_clear * double(count));
    EXPECT_GT(clear_dark.size(), 20u);
    for (const MapConfig& config : configs) {
        ASSERT_EQ(config.resolution, resolution);
        const Visibility visible = ask(scene, config).visible;
        const auto is_lit = [&](std::uint32_t i) { return visible.lit(i); };
        EXPECT_EQ(std::count_if(clear_dark.begin(), clear_dark.end(), is_lit), 0)
            << "false lit of " << clear_dark.size() << ", bias mode " << int(config.bias_mode);
        EXPECT_EQ(std::count_if(clear_lit.begin(), clear_lit.end(), std::not_fn(is_lit)), 0)
            << "false shadowed of " << clear_lit.size() << ", bias mode " << int(config.bias_mode);
        for (std::uint32_t i = 0; i < scene.points.x.size(); ++i)
            EXPECT_TRUE(scene.points.primitive[i] != kNoPrimitive || visible.lit(i)) << i;
    }
}

TEST_F(ShadowMapTest, RightAwayFromSilhouettes) {
    const Light sun{kDirectional, {0.4f, -1, 0.3f}};
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    // A constant bias hides acne on surfaces up to so many texels of depth per texel only; the
    // points asked about see the light at up to 81 degrees, a slope of 6.6.
    const std::vector<MapConfig> configs{{2048, BiasMode::slope, 1},
                                         {2048, BiasMode::receiver_plane, 0.25f},
                                         {2048, BiasMode::constant, 7}};
    for (const char* name : {"box", "city", "spheres"}) {
        SCOPED_TRACE(name);
        const Scene scene =
            std::string(name) == "box" ? box_over_floor(seed) : generated(name, 1000, seed);
        expect_right_when_clear(scene, configs);
        expect_right_when_clear(with_light(scene, sun), configs);
    }
}

TEST_F(ShadowMapTest, SunAlongAnyAxis) {
    const Scene scene = box_over_floor();
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {1.f, -1.f}) {
            SCOPED_TRACE(testing::Message() << "axis " << axis << ", sign " << sign);
            Light sun{kDirectional, glm::vec3(0)};
            sun.vector[axis] = 3 * sign;
            expect_right_when_clear(with_light(scene, sun), {MapConfig{}}, axis == 1 ? 0.2 : 0.0);
        }
}

TEST_F(ShadowMapTest, ErrorFallsWithResolution) {
    for (const char* name : {"city", "spheres"})
        for (bool directional : {false, true}) {
            SCOPED_TRACE(testing::Message() << name << (directional ? ", sun" : ", point light"));
            Scene scene = generated(name, 1000);
            if (directional) scene.light = {kDirectional, {0.4f, -1, 0.3f}};
            const auto errors = [&](std::uint32_t resolution) {
                return wrong(scene, ask(scene, {resolution}));
            };
            const std::size_t coarse = errors(512), middle = errors(2048), fine = errors(4096);
            std::printf("%s%s: %zu, %zu, %zu wrong of 4096\n", name, directional ? ", sun" : "",
                        coarse, middle, fine);
            EXPECT_GT(coarse, middle);
            EXPECT_GT(middle, fine);
            EXPECT_GT(coarse, 2 * fine);
        }
}

TEST_F(ShadowMapTest, EachBiasModeHidesAcne) {
    Scene scene;
    add_floor(scene.mesh, 10, 0, 3);
    scene.points = tests::random_points(scene.mesh, kSide, kSide, 3);
    for (const Light& light :
         {Light{Light::Type::point, {1.3f, 2.1f, -0.4f}}, Light{kDirectional, {1.7f, -1, 0.6f}}}) {
        SCOPED_TRACE(int(light.type));
        scene.light = light;
        const auto acne = [&](BiasMode mode, float bias) {
            return shadowed(scene, ask(scene, {2048, mode, bias}));
        };
        EXPECT_GT(acne(BiasMode::constant, 0), 400u);
        EXPECT_GT(acne(BiasMode::slope, 0), 400u);
        EXPECT_EQ(acne(BiasMode::slope, 1), 0u);
        EXPECT_EQ(acne(BiasMode::constant, 16), 0u);
        EXPECT_EQ(acne(BiasMode::receiver_plane, 0), 0u);
        EXPECT_EQ(acne(BiasMode::receiver_plane, 0.25f), 0u);
    }
}

TEST_F(ShadowMapTest, TooMuchBiasLetsLightThrough) {
    const Scene scene = box_over_floor();
    const auto lit_by_bias = [&](BiasMode mode) {
        return shadowed(scene, ask(scene, {512, mode, 1})) -
               shadowed(scene, ask(scene, {512, mode, 1000}));
    };
    EXPECT_GT(lit_by_bias(BiasMode::constant), 50u);
    EXPECT_GT(lit_by_bias(BiasMode::receiver_plane), 50u);
}

TEST_F(ShadowMapTest, FacesMeetWithoutSeams) {
    // A ball around the light hides a larger one everywhere; then with a hole, through which the
    // light reaches points at the edges and corners of the cube's faces.
    std::vector<glm::vec3> places;
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner)
            for (int i = 0; i < 300; ++i) {
                glm::vec3 edge;
                edge[axis] = float(i - 150) / 150;
                edge[(axis + 1) % 3] = corner & 1 ? 1.f : -1.f;
                edge[(axis + 2) % 3] = (corner & 2 ? 1.f : -1.f) * (1 + 1e-4f * float(i % 7 - 3));
                places.push_back(5.f * edge + glm::vec3(0.1f, 0.2f, 0.3f));
            }
    Scene scene;
    scene.light.vector = {0.1f, 0.2f, 0.3f};
    scene.mesh = tests::sphere(40, 80, scene.light.vector, 2);
    scene.points = tests::free_points(places, kSide, kSide);
    for (BiasMode mode : {BiasMode::constant, BiasMode::slope, BiasMode::receiver_plane}) {
        const Answer answer = ask(scene, {512, mode, 1});
        EXPECT_EQ(answer.faces, 6u);
        EXPECT_EQ(shadowed(scene, answer), places.size());
    }
    Scene open = scene;
    open.mesh = {};
    std::mt19937 random(4);
    for (std::size_t t = 0; t < scene.mesh.triangle_count(); ++t)
        if (random() % 8 > 0)
            tests::add_triangle(open.mesh, scene.mesh.corner(t, 0), scene.mesh.corner(t, 1),
                                scene.mesh.corner(t, 2));
    expect_right_when_clear(open, {{2048, BiasMode::slope, 1}});
}

TEST_F(ShadowMapTest, FacesWithoutCastersAreSkipped) {
    Scene scene;
    add_floor(scene.mesh, 1, 0);
    scene.points = tests::random_points(scene.mesh, kSide, kSide, 1);
    scene.light.vector = {0, 5, 0};
    const Answer one = ask(scene);
    EXPECT_EQ(one.faces, 1u);
    scene.light.vector = {0, 0.5f, 0};
    const Answer five = ask(scene);
    EXPECT_EQ(five.faces, 5u);
    EXPECT_EQ(five.memory_bytes - one.memory_bytes, 4u * 2048 * 2048 * 4);
    EXPECT_EQ(ask(with_light(scene, {kDirectional, {0, -1, 0}})).faces, 1u);
    add_box(scene.mesh, {-2, -2, -2}, {2, 2, 2});
    EXPECT_EQ(ask(scene).faces, 6u);
    EXPECT_EQ(ask(with_light(scene, {kDirectional, {0, -1, 0}})).faces, 1u);
}

TEST_F(ShadowMapTest, ScalingByPowersOfTwoChangesNoBit) {
    for (bool directional : {false, true}) {
        Scene scene = generated("spheres", 1500);
        if (directional) scene.light = {kDirectional, {0.4f, -1, 0.3f}};
        const std::vector<std::uint32_t> words = ask(scene).visible.words;
        for (float scale : {1.f / (1 << 13), float(1 << 13)}) {
            Scene scaled = scene;
            for (glm::vec3& p : scaled.mesh.positions) p *= scale;
            scaled.light.vector *= scale;
            for (std::vector<float>* plane : {&scaled.points.x, &scaled.points.y, &scaled.points.z})
                for (float& value : *plane) value *= scale;
            EXPECT_EQ(ask(scaled).visible.words, words) << scale << directional;
        }
    }
}

TEST_F(ShadowMapTest, EmptySceneShadowsNothing) {
    Scene scene;
    scene.points = tests::free_points({{0, 0, 0}, {1, 2, 3}}, kSide, kSide);
    for (const Light& light : {Light{}, Light{kDirectional, {0, -1, 0}}}) {
        const Answer answer = ask(with_light(scene, light));
        EXPECT_EQ(answer.faces, 0u);
        EXPECT_THAT(answer.visible.words, testing::Each(~0u));
    }
    ShadowMap map(tests::device(), {});
    map.load(box_over_floor().mesh);
    map.render({Light::Type::point, {0, 9, 0}});
    Visibility visible;
    map.look_up(Points(tests::device(), {}, 0, 0), visible);
    EXPECT_TRUE(visible.words.empty());
}

TEST_F(ShadowMapTest, OneTriangle) {
    Scene scene;
    tests::add_triangle(scene.mesh, {0, 1, 0}, {2, 1, 0}, {0, 1, 2});
    scene.points = tests::free_points({{0.5f, 0, 0.5f},
                                       {0.5f, 2, 0.5f},
                                       {-1, 0, -1},
                                       {0.5f, -1e6f, 0.5f},
                                       {1.5f, 0, 1.5f},
                                       {0.5f, 1e6f, 0.5f}},
                                      kSide, kSide);
    scene.light = {kDirectional, {0, -1, 0}};
    for (BiasMode mode : {BiasMode::constant, BiasMode::slope, BiasMode::receiver_plane})
        EXPECT_EQ(ask(scene, {512, mode, 1}).visible.words[0], ~0b001001u) << int(mode);
    scene.light = {Light::Type::point, {0.5f, 3, 0.5f}};
    EXPECT_EQ(ask(scene).visible.words[0], ~0b001001u);
    // Edge on it has no area to the light.
    scene.light = {kDirectional, {1, 0, 0}};
    EXPECT_EQ(ask(scene).visible.words[0], ~0u);
}

TEST_F(ShadowMapTest, LeavesOutDegenerateAndUnusableTriangles) {
    for (bool directional : {false, true}) {
        Scene scene = box_over_floor();
        if (directional) scene.light = {kDirectional, {0.4f, -1, 0.3f}};
        const Answer expected = ask(scene);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        const float infinity = std::numeric_limits<float>::infinity();
        tests::add_triangle(scene.mesh, {nan, 0, 0}, {1, nan, 0}, {0, 0, 1});
        tests::add_triangle(scene.mesh, {infinity, 5, 0}, {-infinity, 5, 0}, {0, 5, infinity});
        tests::add_triangle(scene.mesh, {100, 100, 100}, {100, 100, 100}, {200, 0, 0});
        tests::add_triangle(scene.mesh, scene.light.vector, {0, 50, 0}, scene.light.vector);
        const Answer answer = ask(scene);
        EXPECT_EQ(answer.visible.words, expected.visible.words);
        EXPECT_EQ(answer.faces, expected.faces);
    }
}

TEST_F(ShadowMapTest, LightsInAwkwardPlaces) {
    Scene scene = box_over_floor();
    const glm::vec3 corner = scene.mesh.corner(128, 0);
    const glm::vec3 inside = scene.mesh.bounds().center();
    for (const glm::vec3 place :
         {corner, inside, glm::vec3(0, 0, 0), glm::vec3(0, 1, 0), glm::vec3(1e6f, 1e6f, 0),
          glm::vec3(0, 1e30f, 0), glm::vec3(0, -3e38f, 0), glm::vec3(1e-40f)}) {
        SCOPED_TRACE(testing::Message() << place.x << ' ' << place.y << ' ' << place.z);
        scene.light = {Light::Type::point, place};
        for (BiasMode mode : {BiasMode::constant, BiasMode::slope, BiasMode::receiver_plane})
            EXPECT_LE(ask(scene, {512, mode, 1}).faces, 6u);
    }
    // A light within the box: outside, nothing but the box is lit.
    scene.light = {Light::Type::point, {0, 2, 0}};
    EXPECT_LT(wrong(scene, ask(scene)), 10u);
    for (const glm::vec3 direction : {glm::vec3(0, -1e-30f, 0), glm::vec3(3e38f, -3e38f, 3e38f)}) {
        scene.light = {kDirectional, direction};
        EXPECT_LT(wrong(scene, ask(scene)), 40u);
    }
}

TEST_F(ShadowMapTest, RefusesUnusableLightsAndSizesInOneLine) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    ShadowMap map(tests::device(), {});
    map.load(box_over_floor().mesh);
    const auto render = [&](const Light& light) { return [&map, light] { map.render(light); }; };
    EXPECT_THAT(render({Light::Type::point, {0, nan, 0}}),
                ThrowsMessage<std::invalid_argument>(HasSubstr("not finite")));
    EXPECT_THAT(render({kDirectional, {0, 0, 0}}),
                ThrowsMessage<std::invalid_argument>(HasSubstr("direction is zero")));
    ShadowMap huge(tests::device(), {1u << 17, BiasMode::slope, 1});
    huge.load(box_over_floor().mesh);
    EXPECT_THAT(
        [&] {
            huge.render({Light::Type::point, {0, 9, 0}});
        },
        ThrowsMessage<taskpool::gpu::Error>(HasSubstr("lower 'resolution'")));
}

TEST_F(ShadowMapTest, ReceiverPlanesErrLeast) {
    for (const char* name : {"city", "spheres"}) {
        const Scene scene = generated(name, 1000);
        const auto errors = [&](BiasMode mode) {
            const std::size_t count = wrong(scene, ask(scene, {1024, mode, usual_bias(mode)}));
            std::printf("%s, bias mode %d: %zu wrong of 4096\n", name, int(mode), count);
            return count;
        };
        const std::size_t least = errors(BiasMode::receiver_plane);
        EXPECT_LT(least, errors(BiasMode::slope));
        EXPECT_LT(least, errors(BiasMode::constant));
    }
}

TEST_F(ShadowMapTest, MethodRunsThroughTheRegistry) {
    const Scene scene = box_over_floor();
    for (const MethodRow& row : registry()) {
        if (row.name != "shadow_map") continue;
        const auto with_bias = [&](double bias) {
            return [&row, bias] {
                row.create(tests::device(), Settings::resolve(row.parameters(), {{"bias", bias}}));
            };
        };
        EXPECT_THAT(with_bias(-0.5), ThrowsMessage<structures::SettingError>(HasSubstr("-0.5")));
        EXPECT_THAT(with_bias(-2), ThrowsMessage<structures::SettingError>(HasSubstr("-2")));
        for (const char* mode : {"constant", "slope", "receiver_plane"}) {
            const double bias = mode[0] == 's' ? 1.5 : -1;
            const Settings settings =
                Settings::resolve(row.parameters(), {{"resolution", std::int64_t{1024}},
                                                     {"bias_mode", std::string(mode)},
                                                     {"bias", bias}});
            const std::unique_ptr<Method> method = row.create(tests::device(), settings);
            EXPECT_FALSE(method->claims_exact());
            method->prepare(scene.mesh);
            const Points points(tests::device(), scene.points, kSide, kSide);
            std::vector<std::uint32_t> first;
            for (int repetition = 0; repetition < 3; ++repetition) {
                const structures::Samples built = method->build(scene.light);
                EXPECT_EQ(built[0].metric, "build_ms");
                EXPECT_GT(built[0].value, 0);
                Visibility visible;
                EXPECT_GT(method->query(points, visible)[0].value, 0);
                if (repetition == 0) first = visible.words;
                EXPECT_EQ(visible.words, first) << "differs from run to run";
            }
        }
        return;
    }
    FAIL() << "not registered";
}

}  // namespace
