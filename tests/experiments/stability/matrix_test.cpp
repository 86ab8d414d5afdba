// The matrix of tests and methods.
#include "experiments/measure/stability_matrix.hpp"

#include <gmock/gmock.h>

#include "experiments/measure/session.hpp"

namespace {

using namespace experiments::measure;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<ResultSummary> results() {
    std::vector<Row> rows;
    const auto add = [&](const char* test, const char* method, structures::Samples samples) {
        for (const structures::Sample& sample : samples)
            rows.push_back({{test, method, "default", 0, 0}, sample});
    };
    add("02_b", "good", {{"stability_passed", 1}, {"instances", 7}, {"claims_exact", 1}});
    add("02_b", kSceneRows, {{"points", 5}});
    add("01_a", "good",
        {{"stability_passed", 0},
         {"instances", 7},
         {"instances_failed", 2},
         {"claims_exact", 1},
         {"false_lit", 3},
         {"exceptions", 1},
         {"worst_x", 0.1f},
         {"worst_y", -2},
         {"worst_z", 3}});
    add("01_a", "rough",
        {{"stability_passed", 0},
         {"instances", 7},
         {"instances_failed", 7},
         {"claims_exact", 0},
         {"unexpected", 4}});
    return summarise(rows);
}

TEST(Matrix, RowsAndColumns) {
    const Matrix matrix = make_matrix(results());
    EXPECT_THAT(matrix.tests, ElementsAre("01_a", "02_b"));
    EXPECT_THAT(matrix.methods, ElementsAre("good", "rough"));
    EXPECT_TRUE(matrix.cell(1, 0).passed);
    EXPECT_FALSE(matrix.cell(0, 0).passed);
    EXPECT_EQ(matrix.cell(0, 0).worst, "(0.100000001, -2, 3)");
    EXPECT_FALSE(matrix.cell(1, 1).taken);
}

TEST(Matrix, TextForTheTerminal) {
    const auto rows = text_rows(make_matrix(results()));
    EXPECT_THAT(rows[0], ElementsAre("test", "good", "rough"));
    EXPECT_THAT(rows[1],
                ElementsAre("01_a", "FAIL 2 of 7: 3 lit, 1 thrown", "FAIL 7 of 7: 4 inexact"));
    EXPECT_THAT(rows[2], ElementsAre("02_b", "pass 7", "-"));
    EXPECT_THAT(rows[3], ElementsAre("passed", "1 of 2", "0 of 2"));
    EXPECT_THAT(make_matrix({}).cells, IsEmpty());
}

TEST(Matrix, OnlyBrokenClaimsFailTheRun) {
    const auto lines = broken_stability_claims(results());
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_THAT(lines[0], HasSubstr("01_a, good"));
    EXPECT_THAT(lines[0], HasSubstr("(0.100000001, -2, 3)"));
}

}  // namespace
