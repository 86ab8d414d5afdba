// The truth on disk: what decides its key, and what becomes of entries and folders that are broken.
#include "experiments/measure/truth_cache.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <random>

#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

namespace fs = std::filesystem;
using experiments::measure::truth_key;
using experiments::measure::TruthCache;
using shadows::truth::Verdicts;
using structures::geometry::Light;
using structures::geometry::TriangleMesh;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kKey(64, 'a');

class TruthCacheTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "grove-truth-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    void TearDown() override { fs::remove_all(folder_); }

    TruthCache cache() { return cache(folder_); }
    TruthCache cache(const fs::path& folder) {
        return {folder, [this](const std::string& line) { warnings_.push_back(line); }};
    }
    fs::path entry() const { return folder_ / "truth" / (kKey + ".truth"); }

    /// `count` verdicts at random, from a fixed seed.
    static Verdicts some_verdicts(std::size_t count) {
        std::mt19937 random(5);
        Verdicts verdicts;
        verdicts.points.resize(count);
        for (auto& verdict : verdicts.points) verdict.bits = std::uint8_t(random());
        verdicts.effort = {11, 22, 33, 4.5};
        return verdicts;
    }

    fs::path folder_;
    std::vector<std::string> warnings_;
};

TEST_F(TruthCacheTest, GivesBackWhatWasStored) {
    const Verdicts stored = some_verdicts(1000);
    EXPECT_FALSE(cache().load(kKey, 1000));
    cache().store(kKey, stored);
    const auto loaded = cache().load(kKey, 1000);
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->points, stored.points);
    EXPECT_EQ(loaded->effort.exact, 22u);
    EXPECT_EQ(loaded->effort.milliseconds, 4.5);
    EXPECT_FALSE(cache().load(std::string(64, 'b'), 1000));
    EXPECT_THAT(warnings_, IsEmpty());
    // The file alone: nothing is left of the writing.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "truth"), {}), 1);
}

/// Any byte changed, any length cut: reported in one line, and judged anew.
TEST_F(TruthCacheTest, DamageIsFound) {
    cache().store(kKey, some_verdicts(50));
    const std::string whole = read_text(entry());
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string text = whole;
        text[at] ^= 1;
        write_text(entry(), text);
        EXPECT_FALSE(cache().load(kKey, 50)) << at;
        write_text(entry(), whole.substr(0, at));
        EXPECT_FALSE(cache().load(kKey, 50)) << at;
    }
    EXPECT_EQ(warnings_.size(), 2 * whole.size());
    EXPECT_THAT(warnings_.back(), HasSubstr("judged again"));
    write_text(entry(), whole);
    EXPECT_TRUE(cache().load(kKey, 50));
    EXPECT_FALSE(cache().load(kKey, 51)) << "another number of points";
    cache().store(kKey, some_verdicts(51));
    EXPECT_TRUE(cache().load(kKey, 51)) << "a damaged entry is replaced";
}

TEST_F(TruthCacheTest, AnEntryOfAnotherKeyIsDamage) {
    cache().store(kKey, some_verdicts(50));
    const std::string other(64, 'c');
    fs::copy_file(entry(), folder_ / "truth" / (other + ".truth"));
    EXPECT_FALSE(cache().load(other, 50));
    EXPECT_THAT(warnings_, ElementsAre(HasSubstr("checksum")));
}

TEST_F(TruthCacheTest, AFolderThatTakesNothingIsReportedOnce) {
    write_text(folder_ / "file", "");
    for (const fs::path& folder : {folder_ / "file", fs::path("/proc/grove")}) {
        TruthCache broken = cache(folder);
        EXPECT_FALSE(broken.load(kKey, 50));
        broken.store(kKey, some_verdicts(50));
        broken.store(kKey, some_verdicts(50));
        EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr(folder.string()), HasSubstr("--cache"),
                                                 testing::Not(HasSubstr("\n")))));
        warnings_.clear();
    }
    TruthCache none = cache({});
    none.store(kKey, some_verdicts(50));
    EXPECT_FALSE(none.load(kKey, 50));
    EXPECT_THAT(warnings_, IsEmpty());
}

/// A limit on the size of files acts as a full disk does.
TEST_F(TruthCacheTest, AFullDiskIsReportedAndLeavesNothing) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{500, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    cache().store(kKey, some_verdicts(5000));
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THAT(warnings_, ElementsAre(HasSubstr("cannot be written")));
    EXPECT_TRUE(fs::is_empty(folder_ / "truth"));
    EXPECT_FALSE(cache().load(kKey, 5000));
}

TEST_F(TruthCacheTest, EveryInputDecidesTheKey) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}};
    const Light light{Light::Type::point, {1, 2, 3}};
    const shadows::PointArrays points{{1, 2}, {3, 4}, {5, 6}, {0, 1}, {{0, 0, 1}, {0, 1, 0}}};
    std::set<std::string> keys{truth_key(mesh, light, points)};
    const auto differs = [&](const TriangleMesh& m, const Light& l, const shadows::PointArrays& p) {
        const std::string key = truth_key(m, l, p);
        EXPECT_EQ(key.size(), 64u);
        EXPECT_TRUE(keys.insert(key).second);
    };
    TriangleMesh other_mesh = mesh;
    other_mesh.positions[3].z = 1e-45f;
    differs(other_mesh, light, points);
    other_mesh = mesh;
    other_mesh.triangles[1] = {2, 1, 3};
    differs(other_mesh, light, points);
    differs(mesh, {Light::Type::directional, light.vector}, points);
    differs(mesh, {Light::Type::point, {1, 2, std::nextafter(3.f, 4.f)}}, points);
    for (int part = 0; part < 5; ++part) {
        shadows::PointArrays other = points;
        if (part == 0) other.x[1] = 7;
        if (part == 1) other.y[1] = 7;
        if (part == 2) other.z[1] = 7;
        if (part == 3) other.primitive[1] = 7;
        if (part == 4) other.normal[1].x = 7;
        differs(mesh, light, other);
    }
    EXPECT_TRUE(keys.contains(truth_key(mesh, light, points)));
}

}  // namespace
}  // namespace tests
