// Runs of the program that succeed, that are interrupted, and that fail in part.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/measure/samples_file.hpp"
#include "experiments/measure/summary.hpp"
#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

using RunTest = CliTest;

const char* const kTwoMethods = "[[method]]\nname = \"rival\"\nflip = 5\nheat = true\n";

TEST_F(RunTest, WritesEverythingAndPrintsTheFolderLast) {
    write_config(kTwoMethods);
    const Outcome run = fake("run test.toml --out r");
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, EndsWith(fmt::format("\n{}\n", (folder_ / "r").string())));
    for (const char* file :
         {"samples.csv", "summary.json", "manifest.json", "report.html", "log.txt"})
        EXPECT_TRUE(fs::exists(folder_ / "r" / file)) << file;

    const auto rows = experiments::measure::read_samples(folder_ / "r/samples.csv");
    const auto results = experiments::measure::summarise(rows);
    ASSERT_EQ(results.size(), 3u);  // two methods and the scene itself
    EXPECT_EQ(results[0].find("build_ms")->statistics.n, 3);
    EXPECT_EQ(results[0].find("differing_points")->statistics.max, 0);
    EXPECT_EQ(results[1].find("differing_points")->statistics.median, 5);
    EXPECT_EQ(results[1].variant, "flip=5,heat=true");

    const auto manifest = json("r/manifest.json");
    EXPECT_EQ(manifest.at("config_sha256").get<std::string>().size(), 64u);
    EXPECT_EQ(manifest.at("sessions").size(), 1u);
    EXPECT_EQ(manifest.at("sessions")[0].at("exit"), 0);
    EXPECT_GT(manifest.at("device").at("subgroup_size"), 0);
    std::map<std::string, int> kinds;
    for (const auto& image : manifest.at("images")) {
        ++kinds[image.at("kind").get<std::string>()];
        EXPECT_TRUE(fs::exists(folder_ / "r" / image.at("file").get<std::string>()));
    }
    EXPECT_EQ(kinds, (std::map<std::string, int>{
                         {"shaded", 2}, {"visibility", 2}, {"errors", 2}, {"heat", 1}}));
}

TEST_F(RunTest, MethodsTakeTurns) {
    write_config(kTwoMethods);
    ASSERT_EQ(fake("run test.toml --out r --quiet").code, 0);
    std::vector<std::string> order;
    for (const auto& row : experiments::measure::read_samples(folder_ / "r/samples.csv"))
        if (row.sample.metric == "build_ms")
            order.push_back(row.key.method + std::to_string(row.key.repetition));
    EXPECT_THAT(order, testing::ElementsAre("stripes0", "rival0", "stripes1", "rival1", "stripes2",
                                            "rival2"));
}

/// The scene of write_config() goes along a path of three frames.
const char* const kPath =
    " --set 'scene.0.path={frames=3, keys=[{light={type=\"point\", position=[-9, 9, 0]}},"
    "{light={type=\"point\", position=[9, 9, 0]}}]}'";

TEST_F(RunTest, PathsAreMeasuredFrameByFrame) {
    write_config(kTwoMethods);
    const Outcome run = fake("run test.toml --out r --quiet" + std::string(kPath));
    ASSERT_EQ(run.code, 0) << run.err;
    const auto rows = experiments::measure::read_samples(folder_ / "r/samples.csv");
    std::map<std::pair<std::string, int>, int> repetitions;  // of method and frame
    std::vector<int> frames;
    for (const auto& row : rows) {
        if (row.sample.metric == "total_ms") ++repetitions[{row.key.method, row.key.frame}];
        if (row.sample.metric == "gbuffer_ms") frames.push_back(row.key.frame);
    }
    EXPECT_EQ(frames, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(repetitions.size(), 6u);
    for (const auto& [key, count] : repetitions) EXPECT_EQ(count, 3);
    // Statistics are over frames and repetitions; every frame has its own truth.
    const auto results = experiments::measure::summarise(rows);
    EXPECT_EQ(results[0].find("total_ms")->statistics.n, 9);
    std::set<double> lit;
    for (const auto& row : rows)
        if (row.sample.metric == "false_lit" && row.key.method == "stripes")
            lit.insert(row.sample.value);
    EXPECT_GT(lit.size(), 1u);
    EXPECT_EQ(json("r/manifest.json").at("images").size(), 7u);  // of the first frame
    EXPECT_THAT(read_text(folder_ / "r/report.html"), HasSubstr("run time along the path"));

    const Outcome drawn = fake("run test.toml --out d --quiet" + std::string(kPath) +
                               " --set scene.0.path.pictures=true");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_EQ(json("d/manifest.json").at("images").size(), 21u);
}

TEST_F(RunTest, KilledPathsGoOnInTheirFrame) {
    write_config(kTwoMethods);
    const std::string run = "run test.toml --out r --quiet" + std::string(kPath);
    // Four answers a frame, the first a warm-up: the last of the second frame.
    const std::string killer = run + " --set method.0.kill_at=8";
    EXPECT_EQ(fake(killer).code, 128 + 9);
    EXPECT_EQ(experiments::measure::read_samples(folder_ / "r/samples.csv").back().key.frame, 1);
    const Outcome resumed = fake(killer + " --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    const auto rows = experiments::measure::read_samples(folder_ / "r/samples.csv");
    std::set<experiments::measure::Key> seen;
    for (const auto& row : rows)
        if (row.sample.metric == "total_ms") {
            EXPECT_TRUE(seen.insert(row.key).second) << row.key.frame;
        }
    EXPECT_EQ(seen.size(), 18u);
}

TEST_F(RunTest, QuietPrintsTheFolderAlone) {
    write_config();
    const Outcome run = fake("run test.toml --out r --quiet");
    EXPECT_EQ(run.out, (folder_ / "r").string() + "\n");
    EXPECT_EQ(run.err, "");
}

TEST_F(RunTest, WithoutOutMakesAFolderBelowRuns) {
    write_config();
    const Outcome first = fake("run test.toml --quiet"), second = fake("run test.toml --quiet");
    EXPECT_EQ(first.code + second.code, 0);
    EXPECT_THAT(first.out, HasSubstr((folder_ / "runs/small-").string()));
    EXPECT_NE(first.out, second.out);
}

TEST_F(RunTest, SweepsRunEveryCombination) {
    write_config();
    const Outcome run = fake(
        "run test.toml --out r --set 'method.0.width=[8,16]' --set 'method.0.scale=[1.0,2.0]' "
        "--set 'scene.0.n=[3,4]'");
    ASSERT_EQ(run.code, 0) << run.err;
    std::set<std::string> seen;
    const auto summary = json("r/summary.json");
    for (const auto& result : summary.at("results"))
        if (result.at("method") == "stripes")
            seen.insert(result.at("scene").get<std::string>() + "|" +
                        result.at("variant").get<std::string>());
    EXPECT_EQ(seen.size(), 8u);
    EXPECT_TRUE(seen.contains("spheres,n=4|width=16,scale=2")) << testing::PrintToString(seen);
}

TEST_F(RunTest, AKilledRunGoesOnWithoutLosingOrRepeatingAnything) {
    write_config();
    // After the warm-up, the fifth query of the process belongs to the fourth of five repetitions.
    const std::string run = "run test.toml --out r --set experiment.repeat=5";
    ASSERT_EQ(fake(run + " --set method.0.kill_at=0 --set method.0.variant=v").code, 0);
    const std::string complete = read_text(folder_ / "r/samples.csv");
    fs::remove_all(folder_ / "r");

    const std::string killer =
        "run test.toml --out r --set experiment.repeat=5 --set method.0.kill_at=5";
    EXPECT_EQ(fake(killer).code, 128 + 9);
    const auto kept = experiments::measure::read_samples(folder_ / "r/samples.csv");
    EXPECT_EQ(kept.back().key.repetition, 2);
    // The next power cut tears a line.
    write_text(folder_ / "r/samples.csv", read_text(folder_ / "r/samples.csv") + "spheres,stri");

    const Outcome resumed = fake(killer + " --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    const auto rows = experiments::measure::read_samples(folder_ / "r/samples.csv");
    const auto results = experiments::measure::summarise(rows);
    EXPECT_EQ(results[0].find("query_ms")->statistics.n, 5);
    EXPECT_TRUE(
        std::equal(kept.begin(), kept.end(), rows.begin(), [](const auto& a, const auto& b) {
            return a.key == b.key && a.sample.metric == b.sample.metric &&
                   a.sample.value == b.sample.value;
        }));
    EXPECT_EQ(std::count(complete.begin(), complete.end(), '\n'),
              std::count_if(rows.begin(), rows.end(), [](const auto&) { return true; }) + 1 + 6)
        << "header, rows, and one closing row per repetition and scene";
    EXPECT_EQ(json("r/manifest.json").at("sessions").size(), 2u);
}

TEST_F(RunTest, ResumingAFinishedRunChangesNoSample) {
    write_config();
    ASSERT_EQ(fake("run test.toml --out r").code, 0);
    const std::string before = read_text(folder_ / "r/samples.csv");
    EXPECT_EQ(fake("run test.toml --out r --resume").code, 0);
    EXPECT_EQ(read_text(folder_ / "r/samples.csv"), before);
}

TEST_F(RunTest, AnotherConfigIsNotResumed) {
    write_config();
    ASSERT_EQ(fake("run test.toml --out r").code, 0);
    const std::string before = read_text(folder_ / "r/samples.csv");
    expect_error(fake("run test.toml --out r --resume --set experiment.repeat=4"), 2,
                 {"--resume", "another config"});
    expect_error(fake("run test.toml --out r"), 2, {"holds a run already", "--resume"});
    EXPECT_EQ(read_text(folder_ / "r/samples.csv"), before);
}

TEST_F(RunTest, AFailingMethodStopsNoOther) {
    write_config(kTwoMethods);
    for (const char* place : {"prepare", "build", "query"}) {
        const std::string out = std::string("r-") + place;
        expect_error(fake("run test.toml --out " + out + " --set method.0.fail=" + place), 1,
                     {"spheres, stripes", std::string("broken on purpose in ") + place});
        const auto summary = json(out + "/summary.json");
        ASSERT_EQ(summary.at("results").size(), 1u);
        EXPECT_EQ(summary.at("results")[0].at("method"), "rival");
        EXPECT_EQ(json(out + "/manifest.json").at("sessions")[0].at("exit"), 1);
        EXPECT_THAT(read_text(folder_ / out / "report.html"), HasSubstr("broken on purpose"));
    }
}

TEST_F(RunTest, AFullDiskLosesNothing) {
    write_config();
    // A disk of its own that is too small at first.
    if (shell("unshare -rm sh -c 'mkdir m && mount -t tmpfs -o size=64k tmpfs m'").code != 0)
        GTEST_SKIP() << "no right to mount a small disk: the full disk was not tried";
    const std::string run = "'" GROVE_FAKE "' run test.toml --out r --set experiment.repeat=200";
    write_text(folder_ / "script",
               "mkdir r; mount -t tmpfs -o size=64k tmpfs r\n" + run +
                   " 2>first.err; echo $? >first.code; cp r/samples.csv kept.csv\n"
                   "mount -o remount,size=64m r\n" +
                   run + " --resume && cp r/samples.csv r/summary.json .\n");
    const Outcome resumed = shell("unshare -rm sh script");
    expect_error(
        {std::stoi(read_text(folder_ / "first.code")), "", read_text(folder_ / "first.err")}, 1,
        {"samples.csv", "No space left", "--resume --out"});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    const auto kept = experiments::measure::read_samples(folder_ / "kept.csv");
    const auto rows = experiments::measure::read_samples(folder_ / "samples.csv");
    EXPECT_GT(kept.size(), 100u);
    ASSERT_GT(rows.size(), kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].key, rows[i].key);
    const auto summary = json("summary.json");
    EXPECT_EQ(summary.at("results")[0].at("metrics").at("query_ms").at("n"), 200);
}

TEST_F(RunTest, BuildsMeasureStructures) {
    write_config();
    write_text(folder_ / "build.toml",
               "[experiment]\nname = \"b\"\nkind = \"build\"\nrepeat = 2\n"
               "[[scene]]\ngenerator = \"spheres\"\nn = 4\n"
               "[[method]]\nname = \"fake_tree\"\nleaf_size = [4, 8]\n");
    const Outcome run = fake("run build.toml --out r");
    ASSERT_EQ(run.code, 0) << run.err;
    const auto results = json("r/summary.json").at("results");
    ASSERT_EQ(results.size(), 3u);
    EXPECT_EQ(results[0].at("metrics").at("sah_cost").at("median"), 25);
    EXPECT_EQ(results[1].at("variant"), "leaf_size=8");
    expect_error(
        fake("run build.toml --out s --set method.0.leaf_size=4 --set method.0.invalid=true"), 1,
        {"invalid", "node 7 is an orphan"});
}

TEST_F(RunTest, SeveralConfigsRunOneAfterTheOther) {
    write_config();
    write_text(folder_ / "second.toml", read_text(folder_ / "test.toml"));
    const Outcome run = fake("run test.toml second.toml --out r --quiet --set experiment.repeat=1");
    // Both are called `small`, so the second finds the first's folder.
    expect_error(run, 2, {"holds a run already"});
    EXPECT_TRUE(fs::exists(folder_ / "r/small/summary.json"));
}

TEST_F(RunTest, TheDeliveredMethodsAgreeOnAGeneratedScene) {
    write_text(folder_ / "real.toml",
               "[experiment]\nkind = \"shadows\"\nrepeat = 1\nreference = \"embree\"\n"
               "[[scene]]\ngenerator = \"city\"\ntriangles = 2000\nresolution = [96, 64]\n"
               "[[method]]\nname = \"embree\"\n[[method]]\nname = \"embree_packet\"\n");
    const Outcome run = real("run real.toml --out r");
    ASSERT_EQ(run.code, 0) << run.err;
    const auto summary = json("r/summary.json");
    EXPECT_EQ(summary.at("results").size(), 3u);
    for (const auto& result : summary.at("results"))
        if (result.at("method") != "(scene)") {
            EXPECT_GT(result.at("metrics").at("points").at("median"), 1000);
            EXPECT_LE(result.at("metrics").at("differing_points").at("median"), 2);
        }
}

}  // namespace
}  // namespace tests
