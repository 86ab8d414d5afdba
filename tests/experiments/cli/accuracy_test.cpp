// Accuracy as the program measures it: metrics, pictures, claims, the cache, hostile lights.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/image/image.hpp"
#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const char* const kCity =
    "[[scene]]\ngenerator = \"city\"\ntriangles = 2000\nresolution = [96, 64]\n";

class AccuracyTest : public CliTest {
  protected:
    /// The delivered program on a small city, with `extra` behind its config.
    Outcome run_city(const std::string& arguments, const std::string& before = {}) {
        write_text(folder_ / "city.toml",
                   std::string("[experiment]\nkind = \"shadows\"\nrepeat = 1\n") + kCity +
                       "[[method]]\nname = \"embree\"\n");
        return real("run city.toml " + arguments, before);
    }
    /// Median of a metric of the first result of `method`; fails if there is none.
    double metric(const std::string& run, const std::string& method, const std::string& name) {
        const auto summary = json(run + "/summary.json");
        for (const auto& result : summary.at("results"))
            if (result.at("method") == method && result.at("metrics").contains(name))
                return result.at("metrics").at(name).at("median");
        ADD_FAILURE() << method << " has no " << name;
        return -1;
    }
    bool has_metric(const std::string& run, const std::string& name) {
        return read_text(folder_ / run / "samples.csv").find("," + name + ",") != std::string::npos;
    }
};

TEST_F(AccuracyTest, EveryAnswerIsJudged) {
    ASSERT_EQ(run_city("--out r").code, 0);
    for (const char* name : {"false_lit", "false_shadowed", "errors_per_million", "ambiguous",
                             "facing_away", "disagreeing_1", "disagreeing_4", "disagreeing_16",
                             "facing_away_errors", "leaks", "leak_largest", "claims_exact"})
        EXPECT_GE(metric("r", "embree", name), 0) << name;
    const double points = metric("r", "embree", "points");
    EXPECT_GT(points, 1000);
    EXPECT_LT(metric("r", "embree", "errors_per_million"), 20000);
    EXPECT_GT(metric("r", "embree", "facing_away"), 0);
    EXPECT_LT(metric("r", "embree", "ambiguous"), points / 10);
    EXPECT_NEAR(metric("r", "embree", "errors_per_million"),
                1e6 *
                    (metric("r", "embree", "false_lit") + metric("r", "embree", "false_shadowed")) /
                    points,
                1e-6);
    EXPECT_GT(metric("r", "(scene)", "truth_filtered"), 0);
    EXPECT_GE(metric("r", "(scene)", "truth_exact"), 0);
    EXPECT_EQ(metric("r", "(scene)", "truth_cached"), 0);
}

TEST_F(AccuracyTest, TheTruthIsJudgedOnce) {
    ASSERT_EQ(run_city("--out a").code, 0);
    ASSERT_EQ(run_city("--out b").code, 0);
    EXPECT_EQ(metric("b", "(scene)", "truth_cached"), 1);
    EXPECT_EQ(metric("b", "(scene)", "truth_ms"), metric("a", "(scene)", "truth_ms"));
    for (const char* name : {"false_lit", "false_shadowed", "ambiguous", "facing_away"})
        EXPECT_EQ(metric("a", "embree", name), metric("b", "embree", name)) << name;
    // Another view of the scene is another question; another folder knows nothing.
    ASSERT_EQ(run_city("--out c --set 'scene.0.resolution=[64, 96]'").code, 0);
    EXPECT_EQ(metric("c", "(scene)", "truth_cached"), 0);
    ASSERT_EQ(run_city("--out d --cache other").code, 0);
    EXPECT_EQ(metric("d", "(scene)", "truth_cached"), 0);
    EXPECT_TRUE(fs::is_directory(folder_ / "other/truth"));
}

TEST_F(AccuracyTest, ADamagedEntryIsRebuilt) {
    ASSERT_EQ(run_city("--out a").code, 0);
    const fs::path entry = fs::directory_iterator(folder_ / "cache/truth")->path();
    const std::string whole = read_text(entry);
    std::string text = whole;
    text[text.size() / 2] ^= 4;
    write_text(entry, text);
    const Outcome run = run_city("--out b");
    EXPECT_EQ(run.code, 0);
    EXPECT_THAT(run.err, HasSubstr("its checksum is wrong; the points are judged again"));
    EXPECT_EQ(metric("b", "(scene)", "truth_cached"), 0);
    EXPECT_EQ(metric("a", "embree", "ambiguous"), metric("b", "embree", "ambiguous"));
    ASSERT_EQ(run_city("--out c").code, 0);
    EXPECT_EQ(metric("c", "(scene)", "truth_cached"), 1);
}

TEST_F(AccuracyTest, ACacheThatTakesNothingCostsALine) {
    const Outcome run = run_city("--out r --cache /proc/grove");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("truth cache: "));
    EXPECT_THAT(run.err, HasSubstr("/proc/grove"));
    EXPECT_EQ(metric("r", "(scene)", "truth_cached"), 0);
    // Where the environment names no place either, nothing is kept and nothing is said.
    const Outcome homeless = run_city("--out s --quiet", "unset GROVE_CACHE HOME XDG_CACHE_HOME;");
    EXPECT_EQ(homeless.code, 0);
    EXPECT_EQ(homeless.err, "");
    ASSERT_EQ(run_city("--out t --quiet", "unset GROVE_CACHE; XDG_CACHE_HOME=$PWD/xdg").code, 0);
    EXPECT_TRUE(fs::is_directory(folder_ / "xdg/grove/truth"));
}

TEST_F(AccuracyTest, TruthCanBeLeftOut) {
    ASSERT_EQ(run_city("--out r --set experiment.truth=false").code, 0);
    EXPECT_FALSE(has_metric("r", "false_lit"));
    EXPECT_FALSE(has_metric("r", "truth_ms"));
    EXPECT_FALSE(fs::exists(folder_ / "r/pareto.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "cache"));
    ASSERT_EQ(run_city("--out p --set experiment.pictures=false").code, 0);
    EXPECT_TRUE(has_metric("p", "false_lit"));
    EXPECT_TRUE(json("p/manifest.json").value("images", nlohmann::json()).empty());
    expect_error(run_city("--out s --set experiment.truth=7"), 2,
                 {"experiment.truth", "true or false"});
}

/// The stripes are wrong nearly everywhere: that is a result, unless they claim otherwise.
TEST_F(AccuracyTest, AWrongClaimFailsTheRun) {
    write_config("[[method]]\nname = \"rival\"\nexact = true\n");
    const Outcome run = fake("run test.toml --out r");
    expect_error(run, 1, {"spheres, rival exact=true", "claims to be exact", "falsely lit"});
    EXPECT_GT(metric("r", "stripes", "false_lit"), 0);
    EXPECT_EQ(metric("r", "rival", "claims_exact"), 1);
    EXPECT_EQ(json("r/manifest.json").at("sessions")[0].at("exit"), 1);
    EXPECT_THAT(read_text(folder_ / "r/report.html"), HasSubstr("claims to be exact"));
    // It has been measured all the same; continuing the run neither repeats nor forgives it.
    const std::string samples = read_text(folder_ / "r/samples.csv");
    expect_error(fake("run test.toml --out r --resume"), 1, {"claims to be exact"});
    EXPECT_EQ(read_text(folder_ / "r/samples.csv"), samples);
}

TEST_F(AccuracyTest, MasksHoldTheErrorsThatAreCounted) {
    write_config();
    ASSERT_EQ(fake("run test.toml --out r").code, 0);
    fs::path file;
    const auto manifest = json("r/manifest.json");
    for (const auto& image : manifest.at("images"))
        if (image.at("kind") == "errors") file = folder_ / "r" / std::string(image.at("file"));
    ASSERT_FALSE(file.empty());
    const auto preview = experiments::image::read_png(file);
    EXPECT_EQ(preview.width, 64);
    EXPECT_EQ(preview.channels, 3);
    const auto [image, channels] = experiments::image::read_exr(file.replace_extension(".exr"));
    EXPECT_THAT(channels, testing::ElementsAre("false_lit", "false_shadowed", "in_band"));
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < image.values.size(); ++i) sums[i % 3] += image.values[i];
    EXPECT_EQ(sums[0], metric("r", "stripes", "false_lit"));
    EXPECT_EQ(sums[1], metric("r", "stripes", "false_shadowed"));
    EXPECT_EQ(sums[2], metric("r", "stripes", "disagreeing_1"));
}

TEST_F(AccuracyTest, RunTimeAgainstError) {
    write_config("[[method]]\nname = \"rival\"\nscale = [0.5, 2.0]\n");
    ASSERT_EQ(fake("run test.toml --out r").code, 0);
    const std::string csv = read_text(folder_ / "r/pareto.csv");
    EXPECT_THAT(csv, testing::StartsWith("scene,method,variant,total_ms,errors_per_million,"));
    // All answer alike, so only the fastest is worth its time.
    EXPECT_THAT(csv, HasSubstr("\nspheres,rival,scale=0.5,"));
    std::size_t lines = 0, front = 0;
    for (std::size_t at = 0; (at = csv.find('\n', at)) != std::string::npos; ++at, ++lines)
        front += csv[at - 1] == '1';
    EXPECT_EQ(lines, 4u);
    EXPECT_EQ(front, 1u);
    const std::string plot = read_text(folder_ / "r/images/spheres-pareto.svg");
    EXPECT_THAT(plot, testing::StartsWith("<svg xmlns="));
    EXPECT_THAT(plot, testing::EndsWith("</svg>\n"));
    const std::string html = read_text(folder_ / "r/report.html");
    EXPECT_THAT(html, HasSubstr("<svg class=\"pareto\""));
    EXPECT_THAT(html, HasSubstr(">scale=0.5</text>"));
}

/// Lights at the edge of what single precision holds, on the geometry, and nowhere to be seen from:
/// an answer and a clear outcome, never a crash.
TEST_F(AccuracyTest, HostileLights) {
    write_text(folder_ / "room.obj",
               "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 0.5 0\nv 0.5 0.5 0\nv 0 0.5 0.5\n"
               "f 1 2 3\nf 1 3 4\nf 5 6 7\n");
    const auto run_room = [&](const std::string& light, const std::string& eye = "0, 2, 3") {
        write_text(folder_ / "room.toml",
                   "[experiment]\nkind = \"shadows\"\nrepeat = 1\n[[scene]]\nfile = \"room.obj\"\n"
                   "resolution = [64, 64]\ncamera = { eye = [" +
                       eye + "], target = [0, 2.1, 0.1] }\nlight = " + light +
                       "\n[[method]]\nname = \"bvh\"\n");
        fs::remove_all(folder_ / "r");
        return real("run room.toml --out r");
    };
    const auto point = [](const std::string& position) {
        return "{ type = \"point\", position = [" + position + "] }";
    };
    for (const char* position : {"1, 0, 1", "0, 0.5, 0", "0.25, 0.5, 0", "0.1, 0.5, 0.1",
                                 "0, 1e30, 0", "3e38, 3e38, 3e38", "1e-45, 2, 0"}) {
        const Outcome run = run_room(point(position), "0, 3, 3");
        EXPECT_EQ(run.code, 0) << position << ": " << run.err;
        EXPECT_EQ(metric("r", "bvh", "false_lit") + metric("r", "bvh", "false_shadowed"), 0)
            << position;
    }
    const Outcome far_away = run_room(point("0, 1e30, 0"), "0, 3, 3");
    EXPECT_THAT(far_away.err, HasSubstr("no answer can be called wrong"));
    write_text(folder_ / "room.toml",
               read_text(folder_ / "room.toml") + "[[method]]\nname = \"embree\"\n");
    expect_error(real("run room.toml --out e"), 1, {"room, embree default", "9e+17", "move"});
    EXPECT_EQ(metric("e", "bvh", "errors_per_million"), 0) << "others are measured all the same";
    const Outcome directional =
        run_room("{ type = \"directional\", direction = [0, -1e-38, 0] }", "0, 3, 3");
    EXPECT_EQ(directional.code, 0) << directional.err;
    expect_error(run_room(point("nan, 1, 0")), 2, {"room.toml:", "position", "finite"});
    expect_error(run_room(point("1e39, 1, 0")), 2, {"room.toml:", "position", "finite"});

    // Looking past everything: no point, so nothing to answer.
    const Outcome nothing = run_room(point("0, 2, 0"), "0, 2, 90");
    EXPECT_EQ(nothing.code, 0) << nothing.err;
}

TEST_F(AccuracyTest, NoPointIsNoError) {
    write_text(folder_ / "away.toml",
               std::string("[experiment]\nkind = \"shadows\"\nrepeat = 1\n") + kCity +
                   "camera = { eye = [0, 1000, 0], target = [0, 2000, 0], up = [1, 0, 0] }\n"
                   "[[method]]\nname = \"bvh\"\n[[method]]\nname = \"embree\"\n");
    const Outcome run = real("run away.toml --out r");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("the camera sees no geometry"));
    EXPECT_EQ(metric("r", "bvh", "points"), 0);
    EXPECT_EQ(metric("r", "bvh", "errors_per_million"), 0);
    EXPECT_TRUE(fs::exists(folder_ / "r/report.html"));
}

}  // namespace
}  // namespace tests
