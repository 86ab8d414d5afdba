// The shadow map: right away from silhouettes, better with resolution, its biases do what they
// say, faces meet without seams, and no input breaks it.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "experiments/scenes/generators.hpp"
#include "shadows/method.hpp"
#include "shadows/shadow_map/map.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/occlusion.hpp"

namespace {

using namespace shadows;
using shadow_map::BiasMode;
using shadow_map::MapConfig;
using shadow_map::ShadowMap;
using shadow_map::usual_bias;
using structures::Settings;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using testing::HasSubstr;
using testing::ThrowsMessage;
using ShadowMapTest = tests::GpuTest;

constexpr std::uint32_t kSide = 64;  ///< of an image of points
constexpr Light::Type kDirectional = Light::Type::directional;

struct Scene {
    TriangleMesh mesh;
    Light light;
    PointArrays points;
};

glm::vec3 position(const PointArrays& points, std::size_t i) {
    return {points.x[i], points.y[i], points.z[i]};
}

/// An image without points.
PointArrays no_points() {
    constexpr std::size_t kCount = std::size_t{kSide} * kSide;
    PointArrays points;
    for (std::vector<float>* plane : {&points.x, &points.y, &points.z}) plane->assign(kCount, 0);
    points.primitive.assign(kCount, kNoPrimitive);
    points.normal.assign(kCount, {0, 0, 1});
    return points;
}

void set_point(PointArrays& points, std::size_t i, glm::vec3 p, std::uint32_t primitive) {
    points.x[i] = p.x;
    points.y[i] = p.y;
    points.z[i] = p.z;
    points.primitive[i] = primitive;
}

PointArrays free_points(const std::vector<glm::vec3>& places) {
    PointArrays points = no_points();
    for (std::size_t i = 0; i < places.size(); ++i) set_point(points, i, places[i], kNoReceiver);
    return points;
}

/// Points at random places of random triangles; every tenth stays without geometry.
PointArrays random_points(const TriangleMesh& mesh, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    PointArrays points = no_points();
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        const auto id = static_cast<std::uint32_t>(random() % mesh.triangle_count());
        float u = unit(random), v = unit(random);
        if (random() % 10 == 0) continue;
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::vec3 a = mesh.corner(id, 0), ab = mesh.corner(id, 1) - a,
                        ac = mesh.corner(id, 2) - a;
        set_point(points, i, a + u * ab + v * ac, id);
        points.normal[i] = glm::normalize(glm::cross(ab, ac));
    }
    return points;
}

void add_quad(TriangleMesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    tests::add_triangle(mesh, a, b, c);
    tests::add_triangle(mesh, a, c, d);
}

/// A square floor of half width `half` at height `y`, in 2 * n * n triangles.
void add_floor(TriangleMesh& mesh, float half, float y, int n = 1) {
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto at = [&](int a, int b) {
                return glm::vec3(half * (2.f * a / n - 1), y, half * (2.f * b / n - 1));
            };
            add_quad(mesh, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
        }
}

void add_box(TriangleMesh& mesh, glm::vec3 lower, glm::vec3 upper) {
    const auto at = [&](int corner) {
        return glm::vec3(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                         corner & 4 ? upper.z : lower.z);
    };
    add_quad(mesh, at(0), at(1), at(3), at(2));
    add_quad(mesh, at(4), at(5), at(7), at(6));
    add_quad(mesh, at(0), at(1), at(5), at(4));
    add_quad(mesh, at(2), at(3), at(7), at(6));
    add_quad(mesh, at(0), at(2), at(6), at(4));
    add_quad(mesh, at(1), at(3), at(7), at(5));
}

Scene box_over_floor(std::uint32_t seed = 1) {
    Scene scene;
    add_floor(scene.mesh, 10, 0, 8);
    add_box(scene.mesh, {-1, 1, -2}, {2, 2.5f, 1});
    scene.light.vector = {0.3f, 9, -0.7f};
    scene.points = random_points(scene.mesh, seed);
    return scene;
}

Scene generated(const char* name, std::int64_t triangles, std::uint32_t seed = 1) {
    for (const auto& row : experiments::scenes::generators()) {
        if (row.name != name) continue;
        const Settings settings =
            Settings::resolve(row.parameters(), {{"triangles", structures::Value(triangles)}});
        const experiments::scenes::GeneratedScene made = row.generate(settings);
        Scene scene{made.mesh, made.light, {}};
        scene.points = random_points(scene.mesh, seed);
        return scene;
    }
    throw std::invalid_argument(name);
}

Scene with_light(Scene scene, const Light& light) {
    scene.light = light;
    return scene;
}

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

std::size_t wrong(const Scene& scene, const Answer& answer) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < scene.points.x.size(); ++i) {
        if (scene.points.primitive[i] == kNoPrimitive) continue;
        const tests::Answer truth = tests::occluded_double(
            position(scene.points, i), scene.points.primitive[i], scene.light, scene.mesh);
        if (truth != tests::Answer::unsure)
            count += answer.visible.lit(i) != (truth == tests::Answer::no);
    }
    return count;
}

/// Whether point i is clear of silhouettes and creases: within `texels` texels of the map around it
/// its surface goes on in its plane, and has, with what lies in front of it as far as that plane
/// may rise over them, the same answer: `lit`.
bool clear_of_edges(const Scene& scene, std::uint32_t i, const MapConfig& config, float texels,
                    bool& lit) {
    const glm::vec3 p = position(scene.points, i);
    const bool directional = scene.light.type == kDirectional;
    const glm::vec3 towards =
        directional ? -glm::normalize(scene.light.vector) : scene.light.vector - p;
    const glm::vec3 ray = glm::normalize(towards);
    const float reach =
        directional ? glm::length(scene.mesh.bounds().extent()) : 2 * glm::length(towards);
    const float step = texels * reach / float(config.resolution);
    const std::uint32_t own = scene.points.primitive[i];
    const glm::vec3 normal = own < kNoReceiver ? scene.points.normal[i] : ray;
    const float cosine = glm::dot(normal, ray);
    if (std::abs(cosine) < 0.15f) return false;
    const float rise = 1 + std::sqrt(1 - std::min(cosine * cosine, 1.f)) / std::abs(cosine);
    const glm::vec3 u = glm::normalize(
        glm::cross(ray, std::abs(ray.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(ray, u);
    lit = !tests::occluded(p, own, scene.light, scene.mesh);
    for (int k = 0; k < 8; ++k) {
        const float angle = 0.7853982f * float(k);
        const glm::vec3 offset = step * (std::cos(angle) * u + std::sin(angle) * v);
        const glm::vec3 on_plane = p + offset - glm::dot(normal, offset) / cosine * ray;
        const glm::vec3 rises = rise * step * ray;
        for (float lift : {0.02f, 2.f})
            if (lit == tests::occluded(on_plane + lift * rises, own, scene.light, scene.mesh))
                return false;
        if (own < kNoReceiver &&
            !tests::occluded(on_plane - 0.02f * rises, kNoReceiver, scene.light, scene.mesh))
            return false;
    }
    return true;
}

/// No point that is clear of edges is answered wrongly, and there are many.
void expect_right_when_clear(const Scene& scene, const MapConfig& config,
                             double least_part_clear = 0.2) {
    const Answer answer = ask(scene, config);
    std::size_t clear = 0, points = 0, dark = 0, false_lit = 0, false_shadowed = 0;
    for (std::uint32_t i = 0; i < scene.points.x.size(); ++i) {
        if (scene.points.primitive[i] == kNoPrimitive) {
            EXPECT_TRUE(answer.visible.lit(i)) << "without geometry: " << i;
            continue;
        }
        ++points;
        bool lit = false;
        if (!clear_of_edges(scene, i, config, 4, lit)) continue;
        ++clear;
        dark += !lit;
        false_lit += !lit && answer.visible.lit(i);
        false_shadowed += lit && !answer.visible.lit(i);
    }
    EXPECT_EQ(false_lit, 0u) << "of " << clear << " clear points, " << dark << " dark";
    EXPECT_EQ(false_shadowed, 0u) << "of " << clear << " clear points, " << dark << " dark";
    EXPECT_GT(double(clear), least_part_clear * double(points));
    EXPECT_GT(dark, 20u);
}

TEST_F(ShadowMapTest, RightAwayFromSilhouettes) {
    const Light sun{kDirectional, {0.4f, -1, 0.3f}};
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    const Scene scenes[] = {box_over_floor(seed), generated("city", 1500, seed),
                            generated("spheres", 1500, seed)};
    // A constant bias hides acne on surfaces up to so many texels of depth per texel only; the
    // points asked about see the light at up to 81 degrees, a slope of 6.6.
    const MapConfig configs[] = {{2048, BiasMode::slope, 1},
                                 {2048, BiasMode::receiver_plane, 0.25f},
                                 {4096, BiasMode::constant, 7}};
    for (const Scene& scene : scenes)
        for (const MapConfig& config : configs) {
            SCOPED_TRACE(testing::Message()
                         << "scene " << &scene - scenes << ", bias mode " << int(config.bias_mode));
            expect_right_when_clear(scene, config);
            expect_right_when_clear(with_light(scene, sun), config);
        }
}

TEST_F(ShadowMapTest, SunAlongAnyAxis) {
    const Scene scene = box_over_floor();
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {1.f, -1.f}) {
            SCOPED_TRACE(testing::Message() << "axis " << axis << ", sign " << sign);
            Light sun{kDirectional, glm::vec3(0)};
            sun.vector[axis] = 3 * sign;
            expect_right_when_clear(with_light(scene, sun), {}, axis == 1 ? 0.2 : 0.0);
        }
}

TEST_F(ShadowMapTest, ErrorFallsWithResolution) {
    for (const char* name : {"city", "spheres"})
        for (bool directional : {false, true}) {
            SCOPED_TRACE(testing::Message() << name << (directional ? ", sun" : ", point light"));
            Scene scene = generated(name, 1500);
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
    scene.points = random_points(scene.mesh, 3);
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
    scene.points = free_points(places);
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
    expect_right_when_clear(open, {2048, BiasMode::slope, 1});
}

TEST_F(ShadowMapTest, FacesWithoutCastersAreSkipped) {
    Scene scene;
    add_floor(scene.mesh, 1, 0);
    scene.points = random_points(scene.mesh, 1);
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
    scene.points = free_points({{0, 0, 0}, {1, 2, 3}});
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
    scene.points = free_points({{0.5f, 0, 0.5f},
                                {0.5f, 2, 0.5f},
                                {-1, 0, -1},
                                {0.5f, -1e6f, 0.5f},
                                {1.5f, 0, 1.5f},
                                {0.5f, 1e6f, 0.5f}});
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
        const Scene scene = generated(name, 1500);
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
