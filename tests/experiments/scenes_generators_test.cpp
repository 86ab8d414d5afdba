// Generated scenes: reproducible to the bit, of the size asked for, sound.
#include <algorithm>
#include <array>
#include <bit>
#include <map>

#include "experiments/scenes/creatures.hpp"
#include "experiments/scenes/generators.hpp"
#include "experiments/scenes/shapes.hpp"
#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {

void PrintTo(const GeneratorRow& row, std::ostream* out) { *out << row.name; }

namespace {

using structures::SettingError;
using structures::Settings;
using structures::geometry::TriangleMesh;
using Given = std::map<std::string, structures::Value>;

GeneratedScene generate(const GeneratorRow& row, const Given& given) {
    return row.generate(Settings::resolve(row.parameters(), given));
}

const GeneratorRow& row_named(std::string_view name) {
    for (const GeneratorRow& row : generators())
        if (row.name == name) return row;
    throw std::invalid_argument("no such generator");
}

/// FNV-1a over all coordinates and indices.
std::uint64_t hash(const TriangleMesh& mesh) {
    std::uint64_t result = 0xcbf29ce484222325u;
    const auto mix = [&](std::uint32_t word) { result = (result ^ word) * 0x100000001b3u; };
    for (const glm::vec3 p : mesh.positions)
        for (int k = 0; k < 3; ++k) mix(std::bit_cast<std::uint32_t>(p[k]));
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) mix(t[k]);
    return result;
}

/// Edges that two triangles do not run along in opposite directions.
std::size_t open_edges(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            // A triangle of the same direction on the same edge would not cancel.
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return static_cast<std::size_t>(
        std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

class EveryGenerator : public testing::TestWithParam<GeneratorRow> {};

TEST_P(EveryGenerator, MakesSoundMeshesOfTheSizeAskedFor) {
    for (const std::int64_t triangles : {3000, 10000, 100000, 1000000}) {
        SCOPED_TRACE(triangles);
        const GeneratedScene scene = generate(GetParam(), {{"triangles", triangles}});
        const LoadReport report = count(scene.mesh);
        expect_guarantees({scene.mesh, report});
        EXPECT_EQ(report.degenerate, 0u);
        EXPECT_EQ(report.duplicates, 0u);
        const double error = static_cast<double>(report.triangles) - double(triangles);
        // To within a pipe, a strand or a building; spheres to the next even tessellation.
        if (GetParam().name == "spheres")
            EXPECT_LT(std::abs(error) / double(triangles), triangles < 10000 ? 0.25 : 0.08);
        else
            EXPECT_TRUE(error >= 0 && error < 6000) << error;
        // Closed or upright surfaces, front sides out: the volume they enclose is positive.
        double volume = 0;
        for (const glm::uvec3 t : scene.mesh.triangles)
            volume += glm::dot(glm::dvec3(scene.mesh.positions[t[0]]),
                               glm::cross(glm::dvec3(scene.mesh.positions[t[1]]),
                                          glm::dvec3(scene.mesh.positions[t[2]])));
        EXPECT_GT(volume, 0);
    }
}

TEST_P(EveryGenerator, RepeatsItselfAndHeedsTheSeed) {
    const GeneratorRow& row = GetParam();
    const std::int64_t size = 20000;
    const std::uint64_t first = hash(generate(row, {{"triangles", size}}).mesh);
    EXPECT_EQ(first, hash(generate(row, {{"triangles", size}}).mesh));
    EXPECT_NE(first, hash(generate(row, {{"triangles", size}, {"seed", std::int64_t{2}}}).mesh));
    EXPECT_NE(first, hash(generate(row, {{"triangles", size}, {"seed", std::int64_t{-1}}}).mesh));
}

TEST_P(EveryGenerator, IsTheSameOnEveryPlatform) {
    const std::map<std::string_view, std::uint64_t> expected = {
        {"spheres", 7100313967746362817u},   {"city", 12292383264220993170u},
        {"pipes", 14124933551594691095u},    {"hairball", 504041802385214038u},
        {"bird_cage", 5287992166475818859u}, {"tentacles", 13780364351303062737u},
        {"meshes", 470310788235511760u},     {"crowd", 9217778780671443748u}};
    const GeneratedScene scene = generate(GetParam(), {{"triangles", std::int64_t{20000}}});
    EXPECT_EQ(hash(scene.mesh), expected.at(GetParam().name));
}

TEST_P(EveryGenerator, IsMadeOfClosedSurfacesOnOpenGround) {
    if (GetParam().name == "city") return;  // its boxes have no bottom
    const TriangleMesh mesh = generate(GetParam(), {{"triangles", std::int64_t{50000}}}).mesh;
    const bool ground = GetParam().name != "pipes" && GetParam().name != "hairball";
    EXPECT_EQ(open_edges(mesh), ground ? 4u : 0u);
}

TEST_P(EveryGenerator, HasAViewOfItself) {
    for (const std::int64_t triangles : {10000, 300000}) {
        const GeneratedScene scene = generate(GetParam(), {{"triangles", triangles}});
        EXPECT_EQ(scene.camera.fault(), "");
        EXPECT_EQ(scene.light.type, structures::geometry::Light::Type::point);
        const glm::mat4 clip = scene.camera.view_projection(16.f / 9, 0.001f);
        std::size_t seen = 0;
        for (const glm::vec3 p : scene.mesh.positions) {
            const glm::vec4 q = clip * glm::vec4(p, 1);
            seen += q.w > 0 && std::abs(q.x) < q.w && std::abs(q.y) < q.w;
        }
        EXPECT_GT(seen, scene.mesh.positions.size() / 4);
    }
}

TEST_P(EveryGenerator, DescribesItself) {
    EXPECT_FALSE(GetParam().summary.empty());
    bool triangles = false, seed = false;
    for (const structures::Parameter& parameter : GetParam().parameters()) {
        EXPECT_FALSE(parameter.help.empty()) << parameter.name;
        triangles |= parameter.name == "triangles";
        seed |= parameter.name == "seed";
    }
    EXPECT_TRUE(triangles && seed);
}

INSTANTIATE_TEST_SUITE_P(Rows, EveryGenerator,
                         testing::ValuesIn(generators().begin(), generators().end()),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(Spheres, HaveTheirTessellationSquaredTriangles) {
    for (const std::int64_t n : {1, 3, 10})
        for (const std::int64_t tessellation : {4, 18, 26}) {
            const TriangleMesh mesh =
                generate(row_named("spheres"), {{"n", n}, {"tessellation", tessellation}}).mesh;
            EXPECT_EQ(mesh.triangle_count(), n * n * tessellation * tessellation + 2);
        }
    EXPECT_THROW(generate(row_named("spheres"), {{"tessellation", std::int64_t{17}}}),
                 SettingError);
    EXPECT_THROW(generate(row_named("spheres"), {{"triangles", std::int64_t{500}}}), SettingError);
    EXPECT_THROW(generate(row_named("spheres"),
                          {{"n", std::int64_t{2000}}, {"tessellation", std::int64_t{8000}}}),
                 SettingError);
}

TEST(Pipes, EndAtTheExtremesOfTheirParameters) {
    for (const std::int64_t sides : {3, 64})
        for (const double turn : {0.01, 1.0})
            for (const std::int64_t triangles : {1000, 50000}) {
                const GeneratedScene scene = generate(
                    row_named("pipes"),
                    {{"sides", sides}, {"turn", turn}, {"fill", 0.5}, {"triangles", triangles}});
                EXPECT_GE(scene.mesh.triangle_count(), std::size_t(triangles));
                EXPECT_EQ(count(scene.mesh).degenerate, 0u);
            }
}

TEST(Hairball, IsSoundAtTheExtremesOfItsParameters) {
    for (const std::int64_t segments : {2, 128})
        for (const std::int64_t sides : {3, 16})
            for (const double curl : {0.0, 1.0})
                EXPECT_EQ(count(generate(row_named("hairball"),
                                         {{"segments", segments}, {"sides", sides}, {"curl", curl}})
                                    .mesh)
                              .degenerate,
                          0u);
}

/// Sound, and of the size asked for to within a row of triangles.
void expect_sound(std::string_view name, Given given, std::int64_t triangles) {
    given["triangles"] = triangles;
    const GeneratedScene scene = generate(row_named(name), given);
    EXPECT_EQ(count(scene.mesh).degenerate, 0u);
    EXPECT_GE(scene.mesh.triangle_count(), std::size_t(triangles));
    EXPECT_LT(scene.mesh.triangle_count(), std::size_t(triangles) + 2000);
    EXPECT_EQ(open_edges(scene.mesh), 4u);
    for (const glm::vec3 p : scene.mesh.positions)
        for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(p[k]));
}

TEST(BirdCage, IsSoundAtTheExtremesOfItsParameters) {
    for (const std::int64_t triangles : {1000, 60000})
        for (const std::int64_t bars : {3, 2000})
            for (const std::int64_t hoops : {0, 200})
                for (const std::int64_t birds : {1, 60})
                    expect_sound("bird_cage", {{"bars", bars}, {"hoops", hoops}, {"birds", birds}},
                                 triangles);
}

TEST(Tentacles, AreSoundAtTheExtremesOfTheirParametersAndWave) {
    for (const std::int64_t segments : {4, 256})
        for (const std::int64_t sides : {3, 32})
            for (const double wave : {0.0, 1.0}) {
                const GeneratedScene scene =
                    generate(row_named("tentacles"),
                             {{"segments", segments}, {"sides", sides}, {"wave", wave}});
                EXPECT_EQ(count(scene.mesh).degenerate, 0u);
            }
    const auto at = [](double phase) {
        return hash(generate(row_named("tentacles"), {{"phase", phase}}).mesh);
    };
    EXPECT_NE(at(0), at(0.25));
    EXPECT_EQ(at(0.25), at(1.25));
}

TEST(Meshes, AreSoundAtTheExtremesOfTheirParameters) {
    for (const std::int64_t triangles : {1000, 60000})
        for (const std::int64_t rows : {1, 100})
            for (const std::int64_t columns : {1, 100})
                for (const std::int64_t bars : {0, 5000})
                    expect_sound("meshes", {{"rows", rows}, {"columns", columns}, {"bars", bars}},
                                 triangles);
}

TEST(Crowd, IsSoundAtTheExtremesOfItsParameters) {
    for (const std::int64_t triangles : {1000, 200000})
        for (const std::int64_t each : {250, 10000000})
            for (const std::int64_t models : {1, 64})
                for (const double spacing : {1.0, 20.0})
                    expect_sound(
                        "crowd",
                        {{"model_triangles", each}, {"models", models}, {"spacing", spacing}},
                        triangles);
}

TEST(Crowd, TurnsItsModelsRigidly) {
    // One model: all copies have the same distances between the corners of a triangle.
    const TriangleMesh mesh = generate(row_named("crowd"), {{"models", std::int64_t{1}}}).mesh;
    Random random(1);
    const TriangleMesh model = creature(Species::raptor, random, 6250);
    const std::size_t copies = (mesh.triangle_count() - 2) / model.triangle_count();
    EXPECT_EQ(copies, 15u);
    for (std::size_t i = 0; i < copies * model.triangle_count(); i += 97) {
        const auto edge = [](const TriangleMesh& of, std::size_t t) {
            return glm::length(of.corner(t, 1) - of.corner(t, 0));
        };
        ASSERT_NEAR(edge(mesh, i + 2), edge(model, i % model.triangle_count()), 1e-5);
    }
}

TEST(Creatures, AreClosedStandOnTheGroundAndKeepToTheirSize) {
    for (std::uint32_t species = 0; species < kSpecies; ++species)
        for (const std::size_t triangles : {0, 100, 1000, 30000, 400000}) {
            SCOPED_TRACE(species);
            SCOPED_TRACE(triangles);
            Random random(species + 7);
            const TriangleMesh model = creature(static_cast<Species>(species), random, triangles);
            EXPECT_EQ(count(model).degenerate, 0u);
            EXPECT_EQ(open_edges(model), 0u);
            EXPECT_GE(model.triangle_count(), triangles);
            EXPECT_LE(model.triangle_count(),
                      std::max<std::size_t>(kLeastCreature, triangles + 1000));
            const auto bounds = model.bounds();
            EXPECT_NEAR(bounds.lower.y, -0.02, 1e-5);
            EXPECT_GT(bounds.upper.y, 1.6);
            EXPECT_LT(bounds.upper.y, 2.6);
            for (const glm::vec3 p : model.positions)
                ASSERT_LT(glm::length(glm::vec2(p.x, p.z)), 2.8);
        }
}

TEST(City, IsSoundAtTheExtremesOfItsParameters) {
    for (const double height : {5.0, 400.0})
        for (const double street : {4.0, 100.0}) {
            const TriangleMesh mesh =
                generate(row_named("city"), {{"height", height}, {"street", street}}).mesh;
            EXPECT_EQ(count(mesh).degenerate, 0u);
            for (std::size_t i = 0; i < mesh.triangle_count(); ++i)  // nothing faces down
                ASSERT_GE(glm::cross(mesh.corner(i, 1) - mesh.corner(i, 0),
                                     mesh.corner(i, 2) - mesh.corner(i, 0))
                              .y,
                          -1e-3f);
        }
}

TEST(UnitCircle, IsTheCosineAndSineToTheLastBits) {
    for (int i = -2000; i <= 2000; ++i) {
        const double turns = i / 777.0;
        const glm::dvec2 p = unit_circle(turns);
        EXPECT_NEAR(p.x, std::cos(2 * M_PI * turns), 4e-15);
        EXPECT_NEAR(p.y, std::sin(2 * M_PI * turns), 4e-15);
    }
    EXPECT_EQ(unit_circle(0.25), glm::dvec2(0, 1));
    EXPECT_EQ(unit_circle(-1.5), glm::dvec2(-1, 0));
}

TEST(SeededRandom, IsSplitmix64) {
    Random random(1234567);  // reference values of the published generator
    for (const std::uint64_t expected :
         {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u})
        EXPECT_EQ(random.next(), expected);
    for (int i = 0; i < 1000; ++i) {
        EXPECT_LT(random.index(7), 7u);
        EXPECT_NEAR(glm::length(random.direction()), 1, 1e-14);
    }
}

}  // namespace
}  // namespace experiments::scenes
