#include "tests/shadows/exact_scenes.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "tests/structures/meshes.hpp"
#include "tests/support/occlusion.hpp"
#include "tests/support/points.hpp"

namespace tests {
namespace {

using shadows::kNoPrimitive;
using shadows::kNoReceiver;
using shadows::point_index;
using Scenes = std::vector<ExactScene>;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Numbers {
    std::mt19937 engine;
    explicit Numbers(std::uint32_t seed) : engine(seed) {}
    float unit() { return std::uniform_real_distribution<float>(0, 1)(engine); }
    glm::vec3 in_unit_cube() {
        const float x = unit(), y = unit(), z = unit();
        return {x, y, z};
    }
    /// From -1 to 1.
    glm::vec3 in_cube() { return 2.0f * in_unit_cube() - 1.0f; }
};

ExactScene make_scene(std::string name, std::uint32_t width, std::uint32_t height) {
    ExactScene scene;
    scene.name = std::move(name);
    scene.width = width;
    scene.height = height;
    scene.points = no_points(width, height);
    return scene;
}

glm::vec3 on_triangle(const TriangleMesh& mesh, std::uint32_t t, Numbers& random) {
    glm::vec3 w = random.in_unit_cube() + 1e-3f;
    w /= w.x + w.y + w.z;
    return w.x * mesh.corner(t, 0) + w.y * mesh.corner(t, 1) + w.z * mesh.corner(t, 2);
}

/// Points on the mesh's triangles and in the cube of side `size` around `centre`, by halves.
void scatter_points(ExactScene& scene, std::uint32_t count, Numbers& random, float size,
                    glm::vec3 centre = {}) {
    scene.width = 64;
    scene.height = (count + 63) / 64;
    scene.points = no_points(scene.width, scene.height);
    const auto triangles = static_cast<std::uint32_t>(scene.mesh.triangle_count());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (triangles > 0 && i % 2 == 0) {
            const std::uint32_t t = random.engine() % triangles;
            set_point(scene.points, i, on_triangle(scene.mesh, t, random), t);
        } else {
            set_point(scene.points, i, centre + random.in_cube() * (size / 2));
        }
    }
}

ExactScene with_light(ExactScene scene, const Light& light, const std::string& name) {
    scene.light = light;
    scene.name += ' ' + name;
    return scene;
}

std::string text(float number) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", double(number));
    return buffer;
}

Scenes soups() {
    Scenes scenes;
    for (std::uint32_t triangles : {1u, 2u, 7u, 8u, 9u, 60u, 700u})
        for (float size : {0.01f, 0.1f, 0.5f, 3.0f}) {
            const auto seed = static_cast<std::uint32_t>(new_seed() + scenes.size());
            scenes.push_back(soup(seed, {triangles, size}));
            scenes.push_back(directional(scenes.back(), Numbers(seed).in_cube()));
        }
    return scenes;
}

Scenes few_soups() {
    Scenes scenes;
    for (std::uint32_t triangles : {3u, 40u, 400u}) {
        scenes.push_back(soup(new_seed() + triangles, {triangles, 0.2f}));
        scenes.push_back(directional(scenes.back(), {0.3f, -0.8f, 0.1f}));
    }
    return scenes;
}

Scenes image_sizes() {
    Scenes scenes;
    for (const auto& [width, height] : std::initializer_list<std::pair<int, int>>{
             {1, 1}, {7, 1}, {15, 17}, {16, 16}, {17, 15}, {255, 1}, {201, 77}}) {
        SoupShape shape{40};
        shape.width = static_cast<std::uint32_t>(width);
        shape.height = static_cast<std::uint32_t>(height);
        scenes.push_back(soup(7, shape));
    }
    scenes.push_back(directional(scenes.back(), {0.2f, -1, 0.1f}));
    return scenes;
}

Scenes nothing() {
    Scenes scenes{soup(3, {0}), directional(soup(3, {0}), {0, -1, 0})};
    ExactScene no_points_at_all = soup(3, {50});
    no_points_at_all.points = no_points(no_points_at_all.width, no_points_at_all.height);
    scenes.push_back(no_points_at_all);
    ExactScene no_image = no_points_at_all;
    no_image.width = no_image.height = 0;
    no_image.points = {};
    scenes.push_back(no_image);
    return scenes;
}

Scenes scales_and_offsets() {
    Scenes scenes;
    const auto add = [&](float scale, glm::vec3 offset) {
        SoupShape shape{200, 0.3f, 32, 32, scale, offset};
        scenes.push_back(soup(11, shape));
        scenes.push_back(directional(soup(12, shape), {1, -2, 0.5f}));
    };
    for (float scale : {1e-12f, 1e-4f, 1e4f, 1e12f}) add(scale, {});
    add(16, glm::vec3(1 << 20));
    return scenes;
}

Scenes slivers() {
    ExactScene scene = soup(17, {100, 0.2f, 64, 64});
    scene.name = "slivers edge-on";
    Numbers random(5);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 a = random.in_unit_cube();
        const glm::vec3 along = (scene.light.vector - a) * 0.5f;
        add_triangle(scene.mesh, a, a + along + 1e-4f * random.unit(),
                     a + 0.5f * along + glm::vec3(1e-6f * random.unit(), 0, 1e-5f));
    }
    return {scene, thin_soup(19), directional(thin_soup(19), {0.1f, -1, 0.2f})};
}

Scenes fans() {
    Scenes scenes;
    for (const Light& light :
         {Light{Light::Type::point, {0, 0, 0}}, Light{Light::Type::point, {0.3f, 0.1f, -0.2f}},
          Light{Light::Type::directional, {0, -1, 0}},
          Light{Light::Type::directional, {0.1f, -1, 0.3f}}})
        scenes.push_back(fan(light));
    return scenes;
}

Scenes rooms() {
    Numbers random(new_seed());
    ExactScene full = make_scene("furnished room", 0, 0);
    add_box(full.mesh, {-2, -1, -3}, {2, 1, 3});
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 at = random.in_cube() * glm::vec3(1.9f, 0.9f, 2.9f);
        add_box(full.mesh, at, at + 0.1f * random.unit() + 0.01f);
    }
    scatter_points(full, 2000, random, 7);
    Scenes scenes{room()};
    for (const glm::vec3& at : {glm::vec3(0), glm::vec3(0.3f, -0.2f, 1), glm::vec3(1.99f, 0, 0)})
        scenes.push_back(with_light(full, {Light::Type::point, at}, "at x " + text(at.x)));
    return scenes;
}

Scenes lights_on_a_box() {
    Numbers random(7);
    ExactScene scene = make_scene("light on", 0, 0);
    add_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
    scatter_points(scene, 1500, random, 4);
    return {with_light(scene, {Light::Type::point, {1, 1, 1}}, "vertex"),
            with_light(scene, {Light::Type::point, {1, 1, 0}}, "edge"),
            with_light(scene, {Light::Type::point, {1, 0.25f, 0}}, "face")};
}

Scenes coplanar_receivers() {
    Scenes scenes;
    for (const glm::vec3& at : {glm::vec3(3, 2, 0.2f), glm::vec3(3, 0, 5), glm::vec3(4, -1, 0)})
        scenes.push_back(with_light(coplanar(), {Light::Type::point, at}, "y " + text(at.y)));
    scenes.push_back(directional(coplanar(), {1, 0, 0}));
    scenes.push_back(directional(coplanar(), {1, -1, 0}));
    return scenes;
}

Scenes around_the_light() {
    Numbers random(new_seed());
    ExactScene scene = make_scene("around the light", 0, 0);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 a = random.in_cube(), b = random.in_cube(), c = random.in_cube();
        add_triangle(scene.mesh, 2.0f * a, 2.0f * b, 2.0f * c);
    }
    for (int i = 0; i < 200; ++i) {  // small and close
        const glm::vec3 at = 0.02f * random.in_cube(), b = random.in_cube(), c = random.in_cube();
        add_triangle(scene.mesh, at, at + 0.01f * b, at + 0.01f * c);
    }
    scatter_points(scene, 1500, random, 4);
    return {scene};
}

Scenes cables_in_light() { return {cables(), directional(cables(), {0, -1, 0})}; }

Scenes points_at_the_light() {
    ExactScene scene = soup(new_seed(), {300, 0.5f});
    scene.name = "points at the light";
    for (std::uint32_t i = 0; i < 300; ++i) {
        glm::vec3 p = scene.light.vector;
        if (i % 3 == 1) p[i / 3 % 3] = std::nextafter(p[i / 3 % 3], kInf);
        if (i % 3 == 2) p += std::pow(0.5f, float(i) / 6) * (i % 2 ? 1.0f : -1.0f);
        set_point(scene.points, i, p);
    }
    // Around a light at the origin, distances reach down to where floats end.
    ExactScene tiny = scene;
    tiny.name = "points at the origin";
    tiny.light.vector = {};
    for (std::uint32_t i = 0; i < 300; ++i)
        set_point(tiny.points, i,
                  std::ldexp(1.0f, -int(i) / 2) * glm::vec3(1, 0.5f, i % 2 ? 0.25f : -1));
    add_triangle(tiny.mesh, {1e-20f, 1e-21f, 1e-20f}, {1e-20f, -1e-20f, 0}, {1e-20f, 0, -1e-20f});
    return {scene, tiny};
}

Scenes far_lights() {
    Scenes scenes;
    for (float distance : {1e3f, 1e6f, 1e30f})
        scenes.push_back(with_light(soup(17, {200}),
                                    {Light::Type::point, glm::vec3(0.3f, 1, -0.2f) * distance},
                                    "from " + text(distance)));
    return scenes;
}

Scenes directions() {
    const ExactScene scene = soup(new_seed(), {150});
    Scenes scenes{directional(scene, {1, 1, 1}), directional(scene, {-1, 1, 0})};
    for (int axis = 0; axis < 3; ++axis)
        for (float length : {1.0f, -1.0f, 1e-20f, 1e20f}) {
            glm::vec3 direction(0);
            direction[axis] = length;
            scenes.push_back(directional(scene, direction));
        }
    return scenes;
}

Scenes broken_triangles() {
    ExactScene scene = soup(new_seed(), {100, 0.5f});
    scene.name = "degenerate and infinite";
    const glm::vec3 p(0.1f, 0.2f, 0.3f), q(0.5f, -0.5f, 0.5f);
    add_triangle(scene.mesh, p, p, q);
    add_triangle(scene.mesh, p, p, p);
    add_triangle(scene.mesh, p, q, p + 2.0f * (q - p));
    for (float bad : {kInf, -kInf, kNan}) {
        add_triangle(scene.mesh, p, q, {bad, 0, 0});
        add_triangle(scene.mesh, {0, bad, bad}, q, {0, 0, 1});
    }
    return {scene, directional(scene, {0.2f, -1, 0.4f})};
}

Scenes equal_triangles() {
    ExactScene scene = soup(31, {1, 2, 16, 16});
    for (std::uint32_t& primitive : scene.points.primitive)
        if (primitive == 0) primitive = kNoReceiver;
    scene.name = "equal triangles";
    scene.distinct = 1;
    scene.mesh.triangles.assign(100'000, scene.mesh.triangles[0]);
    return {scene, directional(scene, {0.2f, -1, 0.4f})};
}

Scenes points_on_lines() {
    Scenes scenes;
    for (const glm::vec3& across : {glm::vec3(1, 0, 0), glm::vec3(0, 1e-7f, 1), glm::vec3(0)}) {
        ExactScene scene = soup(new_seed(), {150, 0.5f});
        scene.name = "points on a line";
        for (std::uint32_t i = 0; i < 1024; ++i)
            set_point(scene.points, i, glm::vec3(0.5f, 0.1f, 0.6f) + across * (i / 512.0f - 1));
        scene.light.vector = {0.5f, 0.9f, 0.6f};
        scenes.push_back(scene);
        scenes.push_back(directional(scene, {0, -1, 0}));
        scenes.push_back(directional(scene, {0.1f, -1, 0.7f}));
    }
    return scenes;
}

Scenes exact_zeros() { return {in_one_plane(40), behind_middles_of_edges()}; }

}  // namespace

std::vector<bool> brute_force(const ExactScene& scene) {
    TriangleMesh mesh = scene.mesh;
    if (mesh.triangles.size() > scene.distinct) mesh.triangles.resize(scene.distinct);
    std::vector<bool> lit(scene.points.x.size(), true);
    for (std::size_t i = 0; i < lit.size(); ++i)
        if (scene.points.primitive[i] != kNoPrimitive)
            lit[i] =
                !occluded(position(scene.points, i), scene.points.primitive[i], scene.light, mesh);
    return lit;
}

std::size_t differences(const shadows::Visibility& visible, const std::vector<bool>& expected) {
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < expected.size(); ++i) wrong += visible.lit(i) != expected[i];
    return wrong;
}

std::uint32_t new_seed() {
    static const std::uint32_t seed = [] {
        const std::uint32_t made = std::random_device{}();
        std::printf("seed %u\n", made);
        return made;
    }();
    return seed;
}

ExactScene soup(std::uint32_t seed, const SoupShape& shape) {
    Numbers random(seed);
    ExactScene scene =
        make_scene("soup of " + std::to_string(shape.triangles) + " of " + text(shape.size) +
                       ", scale " + text(shape.scale) + ", seed " + std::to_string(seed),
                   shape.width, shape.height);
    const auto place = [&](glm::vec3 p) { return p * shape.scale + shape.offset; };
    for (std::uint32_t t = 0; t < shape.triangles; ++t) {
        const glm::vec3 at = random.in_unit_cube();
        const auto corner = [&] { return place(at + 0.5f * shape.size * random.in_cube()); };
        const glm::vec3 a = corner(), b = corner(), c = corner();
        add_triangle(scene.mesh, a, b, c);
    }
    const glm::vec3 shift = 0.1f * random.in_unit_cube();
    for (std::uint32_t y = 0; y < shape.height; ++y)
        for (std::uint32_t x = 0; x < shape.width; ++x) {
            const std::uint32_t i = point_index(x, y, shape.width);
            const float kind = random.unit();
            if (kind < 0.05f) continue;
            if (kind < 0.35f && shape.triangles > 0) {
                const std::uint32_t t = random.engine() % shape.triangles;
                set_point(scene.points, i, on_triangle(scene.mesh, t, random), t);
            } else if (kind < 0.5f) {
                set_point(scene.points, i, place(0.5f + random.in_cube()));
            } else {
                const glm::vec3 p(float(x) / shape.width, float(y) / shape.height, 0.1f);
                set_point(scene.points, i, place(p + 0.01f * random.in_unit_cube() + shift));
            }
        }
    scene.light.vector = place(random.in_unit_cube());
    return scene;
}

ExactScene thin_soup(std::uint32_t seed) {
    Numbers random(seed);
    ExactScene scene = soup(seed, {200, 0.1f});
    scene.name = "thin " + scene.name;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 a = random.in_unit_cube(), b = random.in_unit_cube();
        add_triangle(scene.mesh, a, b, a + 0.003f * random.in_cube());
    }
    return scene;
}

ExactScene directional(ExactScene scene, glm::vec3 direction) {
    return with_light(
        std::move(scene), {Light::Type::directional, direction},
        "along " + text(direction.x) + ' ' + text(direction.y) + ' ' + text(direction.z));
}

ExactScene fan(const Light& light) {
    constexpr std::uint32_t kSpokes = 64;
    ExactScene scene = make_scene("fan", 64, 64);
    scene.light = light;
    const glm::vec3 hub(0.1f, -3, 0.2f);
    std::vector<glm::vec3> rim;
    for (std::uint32_t i = 0; i < kSpokes; ++i) {
        const float angle = 6.2831853f * float(i) / kSpokes;
        rim.push_back(hub +
                      glm::vec3(std::cos(angle), 0.25f * std::sin(3 * angle), std::sin(angle)));
    }
    for (std::uint32_t i = 0; i < kSpokes; ++i)
        add_triangle(scene.mesh, hub, rim[i], rim[(i + 1) % kSpokes]);
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        const float t = float(i / 512) / 8;
        const glm::vec3 on = hub + t * (rim[i / 8 % kSpokes] - hub);
        glm::vec3 p = light.type == Light::Type::point ? light.vector + 2.0f * (on - light.vector)
                                                       : on + 2.0f * light.vector;
        for (int axis = 0; axis < 3; ++axis)
            if (i >> axis & 1) p[axis] = std::nextafter(p[axis], 1e9f);
        set_point(scene.points, point_index(i % 64, i / 64, 64), p);
    }
    return scene;
}

ExactScene room() {
    ExactScene scene = make_scene("room", 32, 32);
    add_box(scene.mesh, {-1, -1, -1}, {1, 1, 1});
    for (std::uint32_t i = 0; i < 1024; ++i)
        set_point(scene.points, point_index(i % 32, i / 32, 32),
                  glm::vec3(int(i % 16) - 8, int(i / 16 % 8) - 4, int(i / 128) - 4) * 0.25f);
    return scene;
}

ExactScene coplanar() {
    ExactScene scene = make_scene("coplanar", 32, 32);
    for (int i = 0; i < 8; ++i) add_triangle(scene.mesh, {i, 0, 0}, {i + 1, 0, 0}, {i, 0, 1});
    for (std::uint32_t i = 0; i < 1024; ++i)
        set_point(scene.points, point_index(i % 32, i / 32, 32),
                  {float(i % 32) / 4, 0, float(i / 32) / 32}, i % 32 / 4);
    return scene;
}

ExactScene cables() {
    Numbers random(new_seed());
    ExactScene scene = make_scene("cables", 0, 0);
    for (int i = 0; i < 100; ++i) {
        const float y = random.unit(), z = 2 * random.unit() - 1;
        const glm::vec3 a(-1, y, z), b(1, random.unit(), 2 * random.unit() - 1);
        const glm::vec3 thick(0, 1e-4f, 1e-4f);
        add_quad(scene.mesh, a, b, b + thick, a + thick);
    }
    scatter_points(scene, 2000, random, 2, {0, -1, 0});
    scene.light.vector = {0.1f, 3, 0.2f};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec3 on = on_triangle(scene.mesh, i % 200, random);
        set_point(scene.points, i, scene.light.vector + 1.5f * (on - scene.light.vector));
    }
    return scene;
}

ExactScene in_one_plane(int triangles) {
    Numbers random(new_seed());
    ExactScene scene = make_scene("in one plane", 64, 32);
    const auto whole = [&] { return std::round(500 * (2 * random.unit() - 1)); };
    const auto in_plane = [&] {
        const float across = whole(), along = whole();
        return across * glm::vec3(1, 2, 4) + along * glm::vec3(3, -1, 5);
    };
    for (int i = 0; i < triangles; ++i) {
        const glm::vec3 a = in_plane(), b = in_plane(), c = in_plane();
        add_triangle(scene.mesh, a, b, c);
    }
    for (std::uint32_t i = 0; i < 2000; ++i) set_point(scene.points, i, in_plane());
    scene.light.vector = in_plane();
    return scene;
}

ExactScene behind_middles_of_edges() {
    Numbers random(new_seed());
    ExactScene scene = make_scene("behind the middles of edges", 32, 32);
    const auto even = [&] { return 2.0f * glm::round(50.0f * random.in_cube()); };
    scene.light.vector = even();
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec3 a = even(), b = even(), c = even();
        if (i % 50 == 0) add_triangle(scene.mesh, a, b, c);
        const std::size_t t = scene.mesh.triangle_count() - 1;
        const int k = int(i % 3);
        const glm::vec3 middle =
            0.5f * (scene.mesh.corner(t, k) + scene.mesh.corner(t, (k + 1) % 3));
        set_point(scene.points, i, middle + float(1 + i % 5) * (middle - scene.light.vector));
    }
    return scene;
}

std::span<const SceneGroup> scene_groups() {
    static const SceneGroup all[] = {
        {"nothing", &nothing, true},
        {"few soups", &few_soups, true},
        {"soups", &soups, false},
        {"image sizes", &image_sizes, false},
        {"scales and offsets", &scales_and_offsets, false},
        {"slivers", &slivers, true},
        {"fans", &fans, false},
        {"rooms", &rooms, false},
        {"lights on a box", &lights_on_a_box, true},
        {"coplanar receivers", &coplanar_receivers, false},
        {"around the light", &around_the_light, true},
        {"cables", &cables_in_light, true},
        {"exact zeros", &exact_zeros, true},
        {"points at the light", &points_at_the_light, false},
        {"far lights", &far_lights, false},
        {"directions", &directions, false},
        {"broken triangles", &broken_triangles, true},
        {"equal triangles", &equal_triangles, false},
        {"points on lines", &points_on_lines, false},
    };
    return all;
}

}  // namespace tests
