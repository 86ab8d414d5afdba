// Statistics, samples files and summaries.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>

#include "experiments/measure/digest.hpp"
#include "experiments/measure/metrics.hpp"
#include "experiments/measure/summary.hpp"

namespace tests {
namespace {

using namespace experiments::measure;
namespace fs = std::filesystem;

TEST(Statistics, SmallSamplesByHand) {
    const double one[] = {4}, odd[] = {3, 1, 2}, even[] = {4, 1, 3, 2};
    EXPECT_EQ(statistics(one).median, 4);
    EXPECT_EQ(statistics(one).stddev, 0);
    EXPECT_EQ(statistics(one).ci_low, 4);
    EXPECT_EQ(statistics(odd).median, 2);
    EXPECT_EQ(statistics(odd).stddev, 1);
    EXPECT_EQ(statistics(even).median, 2.5);
    EXPECT_EQ(statistics(even).mean, 2.5);
}

/// Ranks from the published tables of the sign-test interval of a median.
TEST(Statistics, ConfidenceRanks) {
    const std::pair<int, int> kRanks[] = {{5, 1},  {6, 1},  {8, 1},  {9, 2},   {10, 2},
                                          {15, 4}, {20, 6}, {25, 8}, {50, 18}, {100, 40}};
    for (const auto& [n, rank] : kRanks) {
        std::vector<double> values(n);
        for (int i = 0; i < n; ++i) values[i] = i + 1;
        EXPECT_EQ(statistics(values).ci_low, rank) << n;
        EXPECT_EQ(statistics(values).ci_high, n + 1 - rank) << n;
    }
}

TEST(Statistics, IntervalCoversTheMedianOftenEnough) {
    const unsigned seed = 7;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::lognormal_distribution<double> skewed(0, 1);  // its median is 1
    int covered = 0;
    const int rounds = 4000;
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> values(11);
        for (double& value : values) value = skewed(random);
        const Statistics s = statistics(values);
        covered += s.ci_low <= 1 && 1 <= s.ci_high;
    }
    EXPECT_GT(covered, 0.95 * rounds);
}

class Samples : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "grove-samples-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        file_ = folder_ / "samples.csv";
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_, file_;
};

TEST_F(Samples, RoundTripWithAwkwardLabels) {
    const Key key{"a,b", "say \"hi\"", "x=1,y=2", 3, 4};
    {
        SamplesFile file(file_);
        file.append(key, {{"build_ms", 0.1, "ms"}, {"points", 1e15}});
        EXPECT_TRUE(file.complete(key));
    }
    const auto rows = read_samples(file_);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].key, key);
    EXPECT_EQ(rows[0].sample.value, 0.1);
    EXPECT_EQ(rows[1].sample.value, 1e15);
    EXPECT_TRUE(SamplesFile(file_).complete(key));
}

/// Cut anywhere, the file opens with exactly the repetitions that were closed before the cut.
TEST_F(Samples, SurvivesACutAtEveryByte) {
    {
        SamplesFile file(file_);
        for (int i = 0; i < 3; ++i)
            file.append({"s", "m", "v", 0, i},
                        {{"build_ms", 1.5 + i, "ms"}, {"query_ms", 2, "ms"}});
    }
    std::ifstream stream(file_);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
        std::ofstream(file_) << whole.substr(0, cut);
        std::size_t closed = 0;
        for (std::size_t at = 0; (at = whole.find("complete,1,1\n", at)) != std::string::npos; ++at)
            closed += at + 13 <= cut;
        {
            SamplesFile file(file_);
            for (int i = 0; i < 3; ++i)
                EXPECT_EQ(file.complete({"s", "m", "v", 0, i}), std::size_t(i) < closed);
            file.append({"s", "m", "v", 0, 9}, {{"build_ms", 9, "ms"}});
        }
        EXPECT_EQ(read_samples(file_).size(), 2 * closed + 1);
    }
}

TEST_F(Samples, RefusesOtherFiles) {
    std::ofstream(file_) << "x,y\n1,2\n";
    EXPECT_THROW(SamplesFile{file_}, std::runtime_error);
    EXPECT_THROW(SamplesFile{folder_ / "none" / "samples.csv"}, OutputError);
}

/// A limit on the size of files acts as a full disk does.
TEST_F(Samples, AFullDiskIsReported) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    SamplesFile file(file_);
    const rlimit small{500, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    int written = 0;
    EXPECT_THROW(
        for (;; ++written) file.append({"s", "m", "v", 0, written}, {{"build_ms", 1, "ms"}}),
        OutputError);
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_GT(written, 5);
    EXPECT_EQ(read_samples(file_).size(), std::size_t(written));
}

TEST(Summary, JsonRoundTrip) {
    std::vector<Row> rows;
    for (int i = 0; i < 7; ++i) {
        rows.push_back({{"s", "m", "v", 0, i}, {"build_ms", 1.0 + i, "ms"}});
        rows.push_back({{"s", "m", "w", 0, i}, {"build_ms", 2.0 * i, "ms"}});
    }
    const auto results = summarise(rows);
    const auto again = from_json(to_json(results), "x");
    ASSERT_EQ(again.size(), 2u);
    EXPECT_EQ(again[1].variant, "w");
    EXPECT_EQ(again[0].find("build_ms")->statistics.median, 4);
    EXPECT_EQ(again[1].find("build_ms")->statistics.ci_high, 12);
    EXPECT_THROW(from_json({{"schema", 2}}, "x"), std::runtime_error);
}

TEST(Summary, WhatIsNoNumberStaysNoNumber) {
    const std::vector<Row> rows{{{"s", "m", "v", 0, 0}, {"epo", NAN}}};
    const auto text = to_json(summarise(rows)).dump();
    const auto again = from_json(nlohmann::json::parse(text), "x");
    EXPECT_TRUE(std::isnan(again[0].find("epo")->statistics.median));
}

TEST(Summary, ReadableNumbers) {
    EXPECT_EQ(readable(1234567, "1"), "1,234,567");
    EXPECT_EQ(readable(0, "1"), "0");
    EXPECT_EQ(readable(12.3456, "ms"), "12.35 ms");
    EXPECT_EQ(readable(1.5e6, "bytes"), "1.500 MB");
    EXPECT_EQ(readable(999, "bytes"), "999 B");
    EXPECT_EQ(readable(-12345, "1"), "-12,345");
}

TEST(Digest, KnownAnswer) {
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Metrics, NamesAreDistinct) {
    for (const Metric& metric : metrics()) EXPECT_EQ(find_metric(metric.name), &metric);
}

}  // namespace
}  // namespace tests
