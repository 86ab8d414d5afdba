// Run time against error: the front by brute force, labels that keep apart, awkward numbers.
#include "experiments/report/pareto.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "experiments/report/labels.hpp"

namespace tests {
namespace {

using namespace experiments::report;
using experiments::measure::ResultSummary;
using experiments::measure::Statistics;
using testing::HasSubstr;

Statistics exactly(double value) { return {1, value, value, value, value, 0, value, value}; }

ResultSummary result(const std::string& variant, double milliseconds, double errors) {
    return {
        "scene",
        "method",
        variant,
        {{"total_ms", "ms", exactly(milliseconds)}, {"errors_per_million", "1", exactly(errors)}}};
}

TEST(Pareto, TheFrontIsWhatNothingBeats) {
    const unsigned seed = 11;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (int round = 0; round < 200; ++round) {
        std::vector<ResultSummary> results;
        for (int i = int(random() % 12); i >= 0; --i)
            results.push_back(
                result(std::to_string(i), 1 + double(random() % 6), double(random() % 4)));
        const std::vector<Tradeoff> list = find_tradeoffs(results);
        ASSERT_EQ(list.size(), results.size());
        for (const Tradeoff& one : list) {
            bool beaten = false;
            for (const Tradeoff& other : list) {
                const double time = other.milliseconds.median, errors = other.errors;
                beaten = beaten || (time < one.milliseconds.median && errors <= one.errors) ||
                         (time <= one.milliseconds.median && errors < one.errors);
            }
            EXPECT_EQ(one.front, !beaten);
        }
    }
}

TEST(Pareto, OnlyJudgedResultsCount) {
    ResultSummary unjudged{"scene", "method", "x", {{"total_ms", "ms", exactly(3)}}};
    EXPECT_TRUE(find_tradeoffs({{unjudged}}).empty());
    EXPECT_EQ(pareto_csv({}), "");
    const std::vector<ResultSummary> results{unjudged, result("a,b", 2, 0.5)};
    EXPECT_EQ(pareto_csv(find_tradeoffs(results)),
              "scene,method,variant,total_ms,errors_per_million,false_lit,false_shadowed,points,"
              "claims_exact,on_front\nscene,method,\"a,b\",2,0.5,0,0,0,0,1\n");
}

/// No coordinate that a browser cannot draw, whatever the numbers.
TEST(Pareto, DrawsAwkwardNumbers) {
    const std::vector<std::pair<double, double>> kCases[] = {
        {{5, 0}},           {{5, 0}, {5, 0}},
        {{0, 0}, {0, 1e6}}, {{1e-9, 1e-3}, {1e9, 1e6}},
        {{3, 7}, {3, 7}},   {{1, 1}, {1.0000001, 1.0000001}},
    };
    for (const auto& points : kCases) {
        std::vector<ResultSummary> results;
        for (const auto& [milliseconds, errors] : points)
            results.push_back(result(fmt::format("<{}", results.size()), milliseconds, errors));
        const std::string svg = pareto_chart("title", find_tradeoffs(results));
        EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
        EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
        EXPECT_THAT(svg, HasSubstr("<title>method &lt;0: "));
        EXPECT_LT(svg.size(), 20000u) << "ticks without end";
    }
}

TEST(Pareto, LabelsKeepApartAndInside) {
    const unsigned seed = 3;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(0, 500), y(0, 300), width(20, 150);
    const Box area{0, 0, 500, 300};
    std::vector<Box> all{{100, 100, 120, 120}};
    LabelPlaces places(area, all);
    for (int i = 0; i < 200; ++i) {
        Box box{};
        const double wide = width(random);
        if (!places.find(x(random), y(random), wide, 14, 60, box)) continue;
        EXPECT_NEAR(box.right - box.left, wide, 1e-9);
        EXPECT_TRUE(area.holds(box));
        for (const Box& other : all) EXPECT_FALSE(box.overlaps(other));
        all.push_back(box);
    }
    EXPECT_GT(all.size(), 30u);
}

}  // namespace
}  // namespace tests
