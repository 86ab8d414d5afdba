// Every exact shadow method, in every way to configure it, answers bit for bit like brute force. A
// new method takes part by its name in kMethods; a new choice of a parameter by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "experiments/gbuffer/gbuffer.hpp"
#include "experiments/scenes/generators.hpp"
#include "tests/shadows/exact_methods.hpp"

namespace {

using namespace tests;
using shadows::MethodRow;
using structures::Settings;
using structures::Value;

const char* const kMethods[] = {"bvh", "izb", "metric_tree"};

struct Configuration {
    std::string method;
    Keys keys;

    bool usual() const { return keys.empty(); }
    std::string name() const {
        std::string name = method;
        for (const auto& [key, value] : keys)
            name += '_' + key + '_' + structures::to_string(value);
        return name;
    }
};

void PrintTo(const Configuration& configuration, std::ostream* out) {
    *out << configuration.name();
}

/// Each value but the default, one at a time. Trees are asked by single rays, whose kernels compile
/// in the least time.
std::vector<Configuration> variants() {
    std::vector<Configuration> all;
    const Keys by_rays{{"query", std::string("lane")}};
    const auto add = [&](const char* method, Keys keys, const char* key, const Value& value) {
        keys[key] = value;
        all.push_back({method, std::move(keys)});
    };
    const auto choices = [&](const char* method, const Keys& keys, const char* key) {
        for (const structures::Parameter& parameter : find_method(method).parameters())
            if (parameter.name == key)
                for (const std::string& choice : parameter.choices)
                    if (Value(choice) != parameter.fallback) add(method, keys, key, choice);
    };
    choices("bvh", {}, "query");
    for (std::int64_t resolution : {1, 64, 512}) add("izb", {}, "resolution", resolution);
    choices("metric_tree", {}, "query");
    choices("metric_tree", by_rays, "build");
    add("metric_tree", by_rays, "capsules", false);
    for (std::int64_t size : {8, 32}) add("metric_tree", by_rays, "cluster_size", size);
    for (const char* test : {"depth_test", "interval_test", "slab_test"})
        add("metric_tree", {}, test, false);
    return all;
}

std::vector<Configuration> defaults() {
    std::vector<Configuration> all;
    for (const char* method : kMethods) all.push_back({method, {}});
    return all;
}

/// Scenes with what brute force says, which is the same for all methods.
struct Asked {
    ExactScene scene;
    std::vector<bool> lit;
};
const std::vector<Asked>& asked(const SceneGroup& group) {
    static std::map<std::string, std::vector<Asked>> known;
    std::vector<Asked>& list = known[group.name];
    if (list.empty())
        for (ExactScene& scene : group.make()) {
            std::vector<bool> lit = brute_force(scene);
            list.push_back({std::move(scene), std::move(lit)});
        }
    return list;
}

class ExactMethods : public GpuTest, public testing::WithParamInterface<Configuration> {};

TEST_P(ExactMethods, EqualBruteForce) {
    const Configuration& configuration = GetParam();
    const auto method = make_method(configuration.method, configuration.keys);
    EXPECT_TRUE(method->claims_exact());
    for (const SceneGroup& group : scene_groups()) {
        if (!configuration.usual() && !group.quick) continue;
        for (const Asked& one : asked(group))
            EXPECT_EQ(differences(answer(*method, one.scene), one.lit), 0u)
                << group.name << ": " << one.scene.name;
    }
}

const auto kName = [](const auto& info) { return info.param.name(); };
INSTANTIATE_TEST_SUITE_P(Default, ExactMethods, testing::ValuesIn(defaults()), kName);
INSTANTIATE_TEST_SUITE_P(Variant, ExactMethods, testing::ValuesIn(variants()), kName);

class ExactMethodsGpu : public GpuTest {};

/// On scenes too large for brute force: like single rays through a BVH.
TEST_F(ExactMethodsGpu, AgreeOnGeneratedScenes) {
    const auto rays = make_method("bvh", {{"query", std::string("lane")}});
    std::vector<std::unique_ptr<shadows::Method>> methods;
    for (const char* name : kMethods) methods.push_back(make_method(name, {}));
    for (const auto& row : experiments::scenes::generators()) {
        const auto scene = row.generate(
            Settings::resolve(row.parameters(), {{"triangles", std::int64_t{10'000}}}));
        const auto seen =
            experiments::gbuffer::render_gbuffer(device(), scene.mesh, scene.camera, 160, 120);
        for (const Light& light : {scene.light, Light{Light::Type::directional, {1, -2, 0.5f}}}) {
            const shadows::Visibility expected = answer(*rays, scene.mesh, light, seen.points);
            for (std::size_t m = 0; m < methods.size(); ++m)
                EXPECT_EQ(answer(*methods[m], scene.mesh, light, seen.points).words, expected.words)
                    << kMethods[m] << " on " << row.name;
        }
    }
}

TEST_F(ExactMethodsGpu, AllThatClaimToBeAreTested) {
    const std::set<std::string_view> tested(std::begin(kMethods), std::end(kMethods));
    for (const MethodRow& row : shadows::registry())
        EXPECT_EQ(row.create(device(), Settings::resolve(row.parameters(), {}))->claims_exact(),
                  tested.contains(row.name))
            << row.name;
}

// What is known of scenes without asking brute force.

TEST(ExactScenes, FanLetsNoLightThrough) {
    for (const Light& light : {Light{Light::Type::point, {0.3f, 0.1f, -0.2f}},
                               Light{Light::Type::directional, {0.1f, -1, 0.3f}}}) {
        const std::vector<bool> lit = brute_force(fan(light));
        for (std::uint32_t i = 0; i < 7 * 512; ++i)
            EXPECT_FALSE(lit[shadows::point_index(i % 64, i / 64, 64)]) << "point " << i;
    }
}

TEST(ExactScenes, RoomIsLitUpToItsWalls) {
    const ExactScene scene = room();
    const std::vector<bool> lit = brute_force(scene);
    for (std::uint32_t i = 0; i < 1024; ++i) {
        const glm::vec3 far = glm::abs(position(scene.points, i));
        EXPECT_EQ(lit[i], std::max({far.x, far.y, far.z}) <= 1) << "point " << i;
    }
}

TEST(ExactScenes, NoTriangleShadowsItsPlane) {
    ExactScene scene = coplanar();
    for (const glm::vec3& at : {glm::vec3(3, 2, 0.2f), glm::vec3(3, 0, 5), glm::vec3(4, -1, 0)}) {
        scene.light = {Light::Type::point, at};
        for (const bool lit : brute_force(scene)) EXPECT_TRUE(lit);
    }
}

}  // namespace
