// What every row of the registry of structures must satisfy. A structure is tested here from the
// moment it is registered.
#include <gmock/gmock.h>

#include <set>

#include "structures/structure.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace structures {

void PrintTo(const StructureRow& row, std::ostream* out) { *out << row.name; }

namespace {

using tests::TriangleMesh;

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

constexpr std::uint32_t kSeed = 2026;

/// `mesh` with a degenerate triangle after each of its own: two equal corners, or all three.
TriangleMesh with_degenerate(const TriangleMesh& mesh) {
    TriangleMesh result{mesh.positions, {}};
    for (const glm::uvec3& t : mesh.triangles) {
        result.triangles.push_back(t);
        result.triangles.push_back(result.triangles.size() % 4 == 1 ? glm::uvec3(t.x, t.y, t.x)
                                                                    : glm::uvec3(t.z));
    }
    return result;
}

std::vector<NamedMesh> small_meshes() {
    std::vector<NamedMesh> all;
    const std::uint32_t lanes = tests::device().subgroup_size();
    for (const std::uint32_t count :
         std::set<std::uint32_t>{0, 1, 2, lanes - 1, lanes, lanes + 1, 1000})
        all.push_back({std::to_string(count) + " random triangles",
                       tests::random_triangles(count, kSeed + count)});
    all.push_back({"10^4 identical triangles", tests::identical_triangles(10'000)});
    all.push_back({"a sphere", tests::sphere(12, 17, {1, -2, 3}, 5)});
    all.push_back(
        {"every other triangle degenerate", with_degenerate(tests::random_triangles(1000, kSeed))});
    TriangleMesh flat = tests::random_triangles(40, kSeed);
    for (glm::uvec3& t : flat.triangles) t = glm::uvec3(t.x);
    all.push_back({"degenerate triangles only", flat});
    return all;
}

class Structures : public testing::WithParamInterface<StructureRow>, public tests::GpuTest {
  protected:
    static std::unique_ptr<Builder> create(const std::map<std::string, Value>& given = {}) {
        const StructureRow& row = GetParam();
        return row.create(tests::device(), Settings::resolve(row.parameters(), given));
    }
    static void build(Builder& builder) { taskpool::pool::run(tests::device(), builder.job()); }

    /// Settings that say how the task pool works, not what it builds, as far as the row has them.
    static std::vector<std::map<std::string, Value>> pool_settings() {
        std::vector<std::map<std::string, Value>> all;
        for (const Parameter& p : GetParam().parameters()) {
            if (p.name == "policy")
                for (const std::string& choice : p.choices) all.push_back({{p.name, choice}});
            if (p.name == "workgroups" || p.name == "subgroups")
                for (const int count : {1, 3, 16}) all.push_back({{p.name, std::int64_t{count}}});
        }
        return all;
    }
};

TEST_P(Structures, BuildsSmallMeshes) {
    const auto builder = create();
    for (const NamedMesh& input : small_meshes()) {
        SCOPED_TRACE(testing::Message() << input.name << ", seed " << kSeed);
        builder->prepare(input.mesh);
        build(*builder);
        EXPECT_THAT(builder->validate(), testing::IsEmpty());
        const std::uint64_t fingerprint = builder->fingerprint();
        for (const Sample& sample : builder->metrics()) EXPECT_FALSE(sample.metric.empty());
        build(*builder);
        EXPECT_EQ(builder->fingerprint(), fingerprint) << "built again";
    }
}

TEST_P(Structures, DoNotDependOnThePool) {
    const auto builder = create();
    for (const auto& settings : pool_settings()) {
        const auto other = create(settings);
        for (const NamedMesh& input : small_meshes()) {
            SCOPED_TRACE(testing::Message() << input.name << ", " << settings.begin()->first
                                            << " = " << to_string(settings.begin()->second));
            builder->prepare(input.mesh);
            build(*builder);
            other->prepare(input.mesh);
            build(*other);
            EXPECT_THAT(other->validate(), testing::IsEmpty());
            EXPECT_EQ(other->fingerprint(), builder->fingerprint());
        }
    }
}

TEST_P(Structures, DifferentMeshesHaveDifferentFingerprints) {
    const auto builder = create();
    std::set<std::uint64_t> fingerprints;
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const TriangleMesh mesh = tests::random_triangles(300, seed);
        builder->prepare(mesh);
        build(*builder);
        if (builder->fingerprint() == 0) GTEST_SKIP() << "its memory cannot be read";
        EXPECT_TRUE(fingerprints.insert(builder->fingerprint()).second) << "seed " << seed;
    }
}

TEST_P(Structures, SayWhatMemoryTheyNeed) {
    // Each buffer may be rounded up, and the mesh comes on top.
    constexpr std::uint64_t kRounding = 64 * 16;
    for (const NamedMesh& input : small_meshes()) {
        SCOPED_TRACE(input.name);
        const std::uint64_t before = tests::device().allocated_bytes();
        const auto builder = create();
        builder->prepare(input.mesh);
        build(*builder);
        const std::uint64_t grown = tests::device().allocated_bytes() - before;
        const std::uint64_t mesh = input.mesh.positions.size() * sizeof(glm::vec3) +
                                   input.mesh.triangles.size() * sizeof(glm::uvec3);
        EXPECT_LE(grown, builder->required_bytes(input.mesh.triangle_count()) + mesh + kRounding);
    }
}

TEST_P(Structures, ComeWithSoundParameters) {
    const StructureRow& row = GetParam();
    EXPECT_FALSE(row.summary.empty());
    EXPECT_THAT(row.name, testing::MatchesRegex("[a-z][a-z0-9_]*"));
    for (const Parameter& p : row.parameters()) EXPECT_FALSE(p.help.empty()) << p.name;
    EXPECT_EQ(Settings::resolve(row.parameters(), {}).label(), "default");
    EXPECT_THROW(Settings::resolve(row.parameters(), {{"no_such_key", true}}), SettingError);
}

INSTANTIATE_TEST_SUITE_P(Registry, Structures, testing::ValuesIn(registry()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(StructureRegistry, HasTheBallTreeAndNoNameTwice) {
    std::set<std::string_view> names;
    for (const StructureRow& row : registry())
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice";
    EXPECT_TRUE(names.contains("ball_tree"));
}

}  // namespace
}  // namespace structures
