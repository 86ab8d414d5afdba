// kind = "stability" from the command line.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "experiments/measure/samples_file.hpp"
#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class StabilityCli : public CliTest {
  protected:
    void config(const std::string& keys, const std::string& rest) {
        write_text(folder_ / "s.toml",
                   "[experiment]\nkind = \"stability\"\ntests = [1, 4]\ntransforms = 1\n"
                   "orders = 1\nscales = [100]\n" +
                       keys + rest);
    }
    nlohmann::json metrics(const std::string& file, const std::string& test,
                           const std::string& method) {
        const auto summary = json(file);
        for (const auto& result : summary.at("results"))
            if (result.at("scene") == test && result.at("method") == method)
                return result.at("metrics");
        return nlohmann::json::object();
    }
};

const char* const kBvh = "[[method]]\nname = \"bvh\"\n";
const char* const kStripes = "[[method]]\nname = \"stripes\"\n";

TEST_F(StabilityCli, BvhPassesAndThePageSaysSo) {
    config("", kBvh);
    const Outcome run = real("run s.toml --out r");
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("04_shared_edge    pass 8"));
    EXPECT_THAT(run.out, HasSubstr("2 of 2"));
    const auto measured = metrics("r/summary.json", "04_shared_edge", "bvh");
    EXPECT_EQ(measured.at("stability_passed").at("median"), 1);
    EXPECT_EQ(measured.at("instances").at("median"), 8);
    EXPECT_EQ(measured.at("false_lit").at("median"), 0);
    EXPECT_EQ(measured.at("points").at("median"), 8 * 256);
    const std::string page = read_text(folder_ / "r/report.html");
    EXPECT_THAT(page, HasSubstr("<td class=\"pass\">8</td>"));
    EXPECT_THAT(page, HasSubstr("no light through an edge of constant x"));
    EXPECT_EQ(json("r/manifest.json").at("config").at("stability").at("tests").size(), 2u);
}

TEST_F(StabilityCli, AMethodMayFailUnlessItClaimsToBeExact) {
    config("", kStripes);
    const Outcome run = fake("run s.toml --out r");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("FAIL 8 of 8"));
    EXPECT_THAT(run.out, HasSubstr("0 of 2"));
    const auto measured = metrics("r/summary.json", "01_quad_diagonal", "stripes");
    EXPECT_EQ(measured.at("stability_passed").at("median"), 0);
    EXPECT_GT(measured.at("false_lit").at("median"), 0);
    EXPECT_GT(measured.at("false_shadowed").at("median"), 0);
    EXPECT_TRUE(measured.contains("worst_x"));
    EXPECT_THAT(read_text(folder_ / "r/report.html"), HasSubstr("<td class=\"fail\">8 of 8"));

    const Outcome claim =
        fake("run s.toml --out c --set method.0.exact=true --set 'experiment.tests=[4]'");
    expect_error(claim, 1, {"04_shared_edge, stripes exact=true", "claims to be exact"});
    // Resuming runs nothing again, and still says what has failed.
    const std::string samples = read_text(folder_ / "c/samples.csv");
    expect_error(fake("run s.toml --out c --resume --set method.0.exact=true "
                      "--set 'experiment.tests=[4]'"),
                 1, {"04_shared_edge, stripes exact=true"});
    EXPECT_EQ(read_text(folder_ / "c/samples.csv"), samples);
}

TEST_F(StabilityCli, ErrorsOfAMethodAreCounted) {
    config("", "[[method]]\nname = \"stripes\"\n[[method]]\nname = \"rival\"\n");
    const std::pair<const char*, const char*> kCases[] = {
        {"query", "broken on purpose in query"},
        {"create again", "broken on purpose in create again"},
        {"size", "words of answers"}};
    for (const auto& [place, message] : kCases) {
        const std::string out = fmt::format("r {}", place);
        const Outcome run =
            fake(fmt::format("run s.toml --out '{0}' --set 'method.0.fail=\"{1}\"'", out, place));
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_THAT(run.err, HasSubstr(message));
        for (const char* test : {"01_quad_diagonal", "04_shared_edge"}) {
            const auto count = [&](const char* method) {
                return metrics(out + "/summary.json", test, method).at("exceptions").at("median");
            };
            EXPECT_EQ(count("stripes"), 8) << place;
            EXPECT_EQ(count("rival"), 0) << place;
        }
    }
}

TEST_F(StabilityCli, AKilledRunGoesOn) {
    config("", kStripes);
    const std::string run = "run s.toml --out r --set method.0.kill_at=";
    EXPECT_EQ(fake(run + "12").code, 128 + 9);  // in the second test
    const auto kept = experiments::measure::read_samples(folder_ / "r/samples.csv");
    EXPECT_EQ(kept.back().key.scene, "01_quad_diagonal");
    ASSERT_EQ(fake(run + "12 --resume").code, 0);
    EXPECT_FALSE(metrics("r/summary.json", "04_shared_edge", "stripes").empty());
    EXPECT_EQ(metrics("r/summary.json", "01_quad_diagonal", "stripes").at("instances").at("n"), 1);
}

TEST_F(StabilityCli, BadConfigs) {
    config("tets = 1\n", kStripes);
    expect_error(fake("run s.toml"), 2, {"unknown key 'tets'", "did you mean 'tests'"});
    config("repeat = 3\n", kStripes);
    expect_error(fake("run s.toml"), 2, {"unknown key 'repeat'"});
    config("", std::string(kStripes) + "[[scene]]\ngenerator = \"spheres\"\n");
    expect_error(fake("run s.toml"), 2, {"s.toml:", "scenes of its own"});
    config("truth = true\n", kStripes);
    expect_error(fake("run s.toml"), 2, {"unknown key 'truth'"});
    config("", kStripes);
    for (const char* bad : {"tests=[29]", "tests=[]", "tests=4", "tests=[\"a\"]", "scales=[0]",
                            "scales=[-1]", "scales=1", "transforms=-1", "orders=1.5"})
        expect_error(fake(fmt::format("run s.toml --set 'experiment.{}'", bad)), 2,
                     {std::string(bad).substr(0, std::string(bad).find('='))});
}

TEST_F(StabilityCli, OtherKindsDoNotKnowItsKeys) {
    write_config("", "transforms = 3\n");
    expect_error(fake("run test.toml"), 2, {"unknown key 'transforms'"});
}

}  // namespace
}  // namespace tests
