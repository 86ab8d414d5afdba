// Embree against brute force: equal wherever brute force is sure.
#include "shadows/embree/embree.hpp"

#include "tests/shadows/brute_force.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/points.hpp"

namespace shadows::embree {
namespace {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

const Light kLights[] = {{Light::Type::point, {0.4f, 0.6f, 3}},
                         {Light::Type::point, {0.5f, 0.5f, 0.5f}},
                         {Light::Type::directional, {0.3f, -0.2f, -2}}};

class EmbreeWidth : public tests::GpuTest, public testing::WithParamInterface<std::uint32_t> {
  protected:
    /// Expects the sure answers of brute force; returns the fraction of close calls.
    double expect_correct(const TriangleMesh& mesh, const Light& light, std::uint32_t width,
                          std::uint32_t height) {
        EmbreeMethod method({.width = GetParam()});
        const Points points(tests::device(), tests::random_points(mesh, width, height, 77), width,
                            height);
        method.prepare(mesh);
        method.build(light);
        Visibility visible;
        method.query(points, visible);
        EXPECT_EQ(visible.words.size(), points.count() / 32);
        std::uint32_t wrong = 0, close = 0;
        for (std::uint32_t i = 0; i < points.count(); ++i) {
            const PointArrays& at = points.host();
            if (at.primitive[i] == kNoPrimitive) {
                EXPECT_TRUE(visible.lit(i));
                continue;
            }
            const tests::Answer answer =
                tests::brute_force(mesh, light, {at.x[i], at.y[i], at.z[i]}, at.primitive[i]);
            if (answer == tests::Answer::close_call)
                ++close;
            else
                wrong += visible.lit(i) != (answer == tests::Answer::lit);
        }
        EXPECT_EQ(wrong, 0u) << "of " << points.valid_count();
        return points.valid_count() > 0 ? double(close) / points.valid_count() : 0;
    }
};
INSTANTIATE_TEST_SUITE_P(Shadows, EmbreeWidth, testing::Values(0, 1, 8, 16, 64));

TEST_P(EmbreeWidth, AgreesWithBruteForceOnTriangleSoup) {
    for (const std::uint32_t seed : {1u, 2u, 3u})
        for (const Light& light : kLights) {
            SCOPED_TRACE(testing::Message() << "seed " << seed);
            EXPECT_LT(expect_correct(tests::random_triangles(60, seed, 0.2f), light, 100, 70), 0.1);
        }
}

TEST_P(EmbreeWidth, AgreesWithBruteForceOnSpheres) {
    TriangleMesh mesh = tests::sphere(12, 16, {0.5f, 0.5f, 1.2f}, 0.3f);
    tests::add_triangle(mesh, {-4, -4, 0}, {5, -4, 0}, {0, 6, 0});
    for (const Light& light : kLights) expect_correct(mesh, light, 64, 50);
}

TEST_P(EmbreeWidth, SmallScenesAndImages) {
    for (const std::size_t count : {0, 1, 2, 5, 9})
        for (const auto& [width, height] : {std::pair{0u, 0u}, {1u, 1u}, {17u, 5u}, {16u, 64u}})
            expect_correct(tests::random_triangles(count, 5, 0.5f), kLights[0], width, height);
}

TEST_P(EmbreeWidth, DegenerateTrianglesCastNothing) {
    TriangleMesh mesh;
    tests::add_triangle(mesh, {-4, -4, 0}, {5, -4, 0}, {0, 6, 0});
    const TriangleMesh floor = mesh;
    for (int i = 0; i < 50; ++i)
        tests::add_triangle(mesh, {-1, i * 0.1f - 2, 1}, {2, i * 0.1f - 2, 1},
                            {5, i * 0.1f - 2, 1});
    EmbreeMethod method({.width = GetParam()});
    const Points points(tests::device(), tests::random_points(floor, 64, 64, 3), 64, 64);
    method.prepare(mesh);
    method.build(kLights[0]);
    Visibility visible;
    method.query(points, visible);
    for (const std::uint32_t word : visible.words) EXPECT_EQ(word, 0xffffffffu);
}

TEST_P(EmbreeWidth, QualityAndThreadsDoNotChangeTheAnswer) {
    const TriangleMesh mesh = tests::random_triangles(2000, 4, 0.05f);
    const Points points(tests::device(), tests::random_points(mesh, 128, 128, 3), 128, 128);
    std::vector<Visibility> answers;
    for (const Quality quality : {Quality::low, Quality::medium, Quality::high})
        for (const unsigned threads : {1u, 3u}) {
            EmbreeMethod method({.width = GetParam(), .quality = quality, .threads = threads});
            method.prepare(mesh);
            method.build(kLights[0]);
            method.query(points, answers.emplace_back());
            int differing = 0;
            for (std::size_t i = 0; i < answers[0].words.size(); ++i)
                differing += std::popcount(answers[0].words[i] ^ answers.back().words[i]);
            EXPECT_LE(differing, 3);  // rays through edges may fall either way
        }
}

TEST(Embree, ReportsWhatItDid) {
    const TriangleMesh mesh = tests::random_triangles(1000, 4, 0.05f);
    const Points points(tests::device(), tests::random_points(mesh, 32, 32, 3), 32, 32);
    EmbreeMethod method({});
    Visibility visible;
    EXPECT_THROW(method.query(points, visible), std::logic_error);
    method.prepare(mesh);
    EXPECT_THROW(method.query(points, visible), std::logic_error);
    std::map<std::string, double> metrics;
    const auto note = [&](const structures::Samples& samples) {
        for (const structures::Sample& sample : samples) metrics[sample.metric] = sample.value;
    };
    note(method.build(kLights[0]));
    note(method.query(points, visible));
    EXPECT_GT(metrics["build_ms"], 0);
    EXPECT_GT(metrics["query_ms"], 0);
    EXPECT_GT(metrics["memory_bytes"], 1000 * (36 + 12));
    EXPECT_EQ(metrics["rays"], points.valid_count());
    // Building again must not pile up memory.
    const double memory = metrics["memory_bytes"];
    for (int i = 0; i < 3; ++i) note(method.build(kLights[2]));
    EXPECT_NEAR(metrics["memory_bytes"], memory, 0.2 * memory);
}

TEST(Embree, RejectsBadSettings) {
    EXPECT_THROW(EmbreeMethod({.width = 4}), std::invalid_argument);
    EXPECT_THROW(EmbreeMethod({.chunk = 100}), std::invalid_argument);
    for (const MethodRow& row : registry())
        if (row.name == "embree_packet") {
            for (const std::int64_t width : {1, 7, 15})
                EXPECT_THROW(row.create(tests::device(), structures::Settings::resolve(
                                                             row.parameters(), {{"width", width}})),
                             std::invalid_argument);
        }
}

TEST(Workers, RunEveryChunkOnceAndRethrow) {
    for (const unsigned threads : {0u, 1u, 7u}) {
        Workers workers(threads);
        for (const std::uint32_t chunks : {0u, 1u, 5u, 1000u}) {
            std::vector<std::atomic<int>> calls(chunks);
            workers.run(chunks, [&](std::uint32_t chunk) { ++calls[chunk]; });
            for (const auto& count : calls) EXPECT_EQ(count, 1);
        }
        EXPECT_THROW(workers.run(100,
                                 [](std::uint32_t chunk) {
                                     if (chunk == 50) throw std::runtime_error("no");
                                 }),
                     std::runtime_error);
        int calls = 0;
        workers.run(1, [&](std::uint32_t) { ++calls; });
        EXPECT_EQ(calls, 1);
    }
}

}  // namespace
}  // namespace shadows::embree
