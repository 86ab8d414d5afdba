// Metric trees as a shadow method, where they are special: lights within clusters, clusters one
// behind the other, clusters left out, and answers that do not depend on how the tree was made.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "experiments/gbuffer/gbuffer.hpp"
#include "experiments/scenes/generators.hpp"
#include "tests/shadows/exact_methods.hpp"
#include "tests/structures/meshes.hpp"

namespace {

using namespace tests;
using shadows::Method;
using structures::Settings;

std::vector<std::string> choices(const std::string& key) {
    for (const structures::Parameter& parameter : find_method("metric_tree").parameters())
        if (parameter.name == key) return parameter.choices;
    throw std::logic_error("metric_tree has no " + key);
}

/// An open tube of eight sides.
void add_tube(TriangleMesh& mesh, glm::vec3 a, glm::vec3 b, float radius, int rings) {
    const glm::vec3 axis = glm::normalize(b - a);
    const glm::vec3 u = glm::normalize(
        glm::cross(axis, std::abs(axis.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(axis, u);
    const auto at = [&](int ring, int side) {
        const float angle = 0.78539816f * float(side % 8);
        return a + (float(ring) / float(rings)) * (b - a) +
               radius * (std::cos(angle) * u + std::sin(angle) * v);
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int side = 0; side < 8; ++side)
            add_quad(mesh, at(ring, side), at(ring, side + 1), at(ring + 1, side + 1),
                     at(ring + 1, side));
}

/// Points in the cube of half side `half` around `centre`.
void ask_around(ExactScene& scene, glm::vec3 centre, float half, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-half, half);
    scene.width = scene.height = 32;
    scene.points = no_points(scene.width, scene.height);
    for (std::size_t i = 0; i < scene.points.x.size(); ++i) {
        const float x = unit(random), y = unit(random), z = unit(random);
        set_point(scene.points, i, centre + glm::vec3(x, y, z));
    }
}

using MetricTreeShadow = GpuTest;

/// A method for each builder. Making one compiles its kernels, those of single rays in the least
/// time.
std::map<std::string, std::unique_ptr<Method>> make_builders(Keys keys = {}) {
    std::map<std::string, std::unique_ptr<Method>> methods;
    keys.emplace("query", std::string("lane"));
    for (const std::string& builder : choices("build")) {
        keys["build"] = builder;
        methods[builder] = make_method("metric_tree", keys);
    }
    return methods;
}

/// Answers like brute force, built in every way; returns how many clusters were special.
double check_builders(const ExactScene& scene) {
    device();  // before the methods, to outlive them
    static const auto methods = make_builders();
    const std::vector<bool> expected = brute_force(scene);
    double special = 0;
    for (const auto& [builder, method] : methods) {
        method->prepare(scene.mesh);
        special = sample(method->build(scene.light), "special_clusters");
        shadows::Visibility visible;
        const shadows::Points points(device(), scene.points, scene.width, scene.height);
        EXPECT_EQ(sample(method->query(points, visible), "incomplete"), 0);
        EXPECT_EQ(differences(visible, expected), 0u) << builder << ", " << scene.name;
    }
    return special;
}

TEST_F(MetricTreeShadow, LightsWithinClusters) {
    // A tetrahedron and a tube are a cluster each: the light inside, on the axis, at the hull, and
    // just outside; near enough for the cluster to be wider than an element may be.
    ExactScene ball;
    ball.name = "in a ball";
    const glm::vec3 corners[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    for (int i = 0; i < 4; ++i)
        add_triangle(ball.mesh, corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]);
    ask_around(ball, {}, 3, 1);
    const float hull = std::sqrt(3.0f);
    for (const glm::vec3& at :
         {glm::vec3(0), glm::vec3(0.2f, 0.1f, 0), glm::vec3(1, 1, 1), glm::vec3(hull, 0, 0),
          glm::vec3(0, -std::nextafter(hull, 2.f), 0), glm::vec3(0, 0, 1.8f)}) {
        ball.light.vector = at;
        EXPECT_GT(check_builders(ball), 0);
    }
    ExactScene tube;
    tube.name = "in a capsule";
    add_tube(tube.mesh, {-2, 0, 0}, {2, 0, 0}, 0.1f, 1);
    ask_around(tube, {}, 3, 2);
    for (const glm::vec3& at :
         {glm::vec3(0), glm::vec3(1.5f, 0, 0), glm::vec3(0.3f, 0.05f, 0.02f), glm::vec3(-2, 0, 0),
          glm::vec3(1, 0.1f, 0), glm::vec3(2.1f, 0, 0)}) {
        tube.light.vector = at;
        EXPECT_GT(check_builders(tube), 0);
    }
    // Beyond its end, on its axis: an element again.
    tube.light.vector = {8, 0, 0};
    EXPECT_EQ(check_builders(tube), 0);
}

TEST_F(MetricTreeShadow, CablesThatPassTheLight) {
    // The first spans more than 90 degrees, as seen from the light.
    ExactScene scene;
    scene.name = "cable";
    add_tube(scene.mesh, {-10, -0.5f, 0}, {10, -0.5f, 0}, 0.02f, 1);
    EXPECT_GT((ask_around(scene, {0, -1, 0}, 1, 3), check_builders(scene)), 0);
    for (int i = 0; i < 40; ++i)
        add_tube(scene.mesh, {-10, -0.5f, 0.1f * float(i)}, {10, -0.5f + 0.01f * float(i), 2},
                 0.02f, 1 + i % 3);
    scene.name = "cables";
    ask_around(scene, {0, -1, 1}, 1, 4);
    EXPECT_GT(check_builders(scene), 0);
    check_builders(directional(scene, {0.1f, -1, 0.3f}));
}

TEST_F(MetricTreeShadow, ClustersInALine) {
    // Ten thousand clusters at one place, as the light sees them.
    ExactScene scene;
    scene.name = "in a line";
    for (int i = 0; i < 10'000; ++i) {
        const float angle = 2.4f * float(i), z = -5 - 0.0495f * float(i);
        const auto corner = [&](float turn) {
            return glm::vec3(0.1f * std::cos(angle + turn), 0.1f * std::sin(angle + turn), z);
        };
        add_triangle(scene.mesh, corner(0), corner(2.1f), corner(4.2f));
    }
    ask_around(scene, {0, 0, -50}, 3, 5);
    for (std::uint32_t& primitive :
         std::span(scene.points.primitive).subspan(256))  // brute force takes long
        primitive = shadows::kNoPrimitive;
    const auto methods = make_builders({{"cluster_size", std::int64_t{1}}});
    for (const ExactScene& lit : {scene, directional(scene, {0, 0, -1})}) {
        const std::vector<bool> expected = brute_force(lit);
        for (const auto& [builder, method] : methods)
            EXPECT_EQ(differences(answer(*method, lit), expected), 0u) << builder << lit.name;
    }
}

TEST_F(MetricTreeShadow, ManyEqualTrianglesBuildInEveryWay) {
    ExactScene scene = soup(31, {1, 2, 16, 16});
    for (std::uint32_t& primitive : scene.points.primitive)
        if (primitive == 0) primitive = shadows::kNoReceiver;
    scene.distinct = 1;
    scene.mesh.triangles.assign(100'000, scene.mesh.triangles[0]);
    check_builders(scene);
}

TEST_F(MetricTreeShadow, ClustersThatFaceAwayAreLeftOut) {
    ExactScene scene;
    for (int x = 0; x < 8; ++x)
        for (int z = 0; z < 8; ++z)  // normals down
            add_quad(scene.mesh, {x, 0, z}, {x + 1, 0, z}, {x + 1, 0, z + 1}, {x, 0, z + 1});
    ask_around(scene, {4, 0, 4}, 4, 6);
    scene.light.vector = {4, 20, 4};
    for (const auto& [builder, method] : make_builders({{"cull_facing", true}})) {
        EXPECT_FALSE(method->claims_exact());
        for (const ExactScene& lit : {scene, directional(scene, {0.1f, -1, 0.2f})}) {
            EXPECT_EQ(differences(answer(*method, lit), std::vector<bool>(1024, true)), 0u)
                << builder;
            EXPECT_EQ(sample(method->build(lit.light), "casters_inserted"), 0);
        }
    }
    // From below, all of them face the light.
    scene.light.vector = {4, -20, 4};
    const auto method = make_method("metric_tree", {{"cull_facing", true}});
    EXPECT_EQ(differences(answer(*method, scene), brute_force(scene)), 0u);
}

TEST_F(MetricTreeShadow, ClosedMeshesMayLeaveOutWhatFacesAway) {
    ExactScene scene;
    scene.mesh = sphere(40, 60, {0, 0, 0}, 1);
    ask_around(scene, {0, 0, 0}, 3, 7);
    scene.light.vector = {0.5f, 4, 0.3f};
    const auto method = make_method("metric_tree", {{"cull_facing", true}});
    method->prepare(scene.mesh);
    const structures::Samples built = method->build(scene.light);
    EXPECT_LT(sample(built, "casters_inserted"), sample(built, "casters_total"));
    EXPECT_EQ(differences(answer(*method, scene), brute_force(scene)), 0u);
}

TEST_F(MetricTreeShadow, TinyLimitsLoseNothing) {
    const ExactScene scene = thin_soup(29);
    const std::vector<bool> expected = brute_force(scene);
    for (const char* query : {"beam", "packet"})
        for (const auto& [key, value] : {std::pair{"stack", 2}, {"density", 0}}) {
            const auto method = make_method(
                "metric_tree", {{"query", std::string(query)}, {key, std::int64_t{value}}});
            EXPECT_EQ(differences(answer(*method, scene), expected), 0u) << query << ' ' << key;
        }
}

/// One value or another, the bits are the same: none changes what is tested exactly, only what is
/// left out.
std::vector<Keys> ways() {
    std::vector<Keys> ways;
    for (const std::string& query : choices("query")) ways.push_back({{"query", query}});
    for (const std::string& builder : choices("build")) ways.push_back({{"build", builder}});
    for (std::int64_t seed = 1; seed <= 10; ++seed) ways.push_back({{"seed", seed}});
    for (std::int64_t size : {1, 8, 64}) ways.push_back({{"cluster_size", size}});
    ways.push_back({{"capsules", false}});
    for (Keys& keys : ways) keys.emplace("query", std::string("lane"));
    return ways;
}

TEST_F(MetricTreeShadow, BitsDependNeitherOnTheTreeNorOnTheClusters) {
    struct Asked {
        TriangleMesh mesh;
        Light light;
        shadows::Points points;
        shadows::Visibility expected;
    };
    std::vector<Asked> scenes;
    const ExactScene thin = thin_soup(new_seed());
    scenes.push_back(
        {thin.mesh, thin.light, shadows::Points(device(), thin.points, thin.width, thin.height)});
    for (const auto& row : experiments::scenes::generators()) {
        if (row.name != "pipes") continue;
        const auto made = row.generate(
            Settings::resolve(row.parameters(), {{"triangles", std::int64_t{10'000}}}));
        auto seen = experiments::gbuffer::render_gbuffer(device(), made.mesh, made.camera, 160, 96);
        scenes.push_back({made.mesh, made.light, std::move(seen.points)});
    }
    ASSERT_EQ(scenes.size(), 2u);
    const auto rays = make_method("bvh", {{"query", std::string("lane")}});
    for (Asked& scene : scenes)
        scene.expected = answer(*rays, scene.mesh, scene.light, scene.points);
    for (const Keys& keys : ways()) {
        const auto method = make_method("metric_tree", keys);
        for (const Asked& scene : scenes)
            EXPECT_EQ(answer(*method, scene.mesh, scene.light, scene.points).words,
                      scene.expected.words)
                << Settings::resolve(find_method("metric_tree").parameters(), keys).label();
    }
}

}  // namespace
