// Method bvh passes the stress suite, in every way to walk its tree.
#include <gtest/gtest.h>

#include "experiments/stability/suite.hpp"
#include "experiments/stability/variations.hpp"
#include "tests/experiments/stability/answer.hpp"

namespace {

using namespace experiments::stability;

class BvhStability : public tests::GpuTest, public testing::WithParamInterface<const char*> {};

TEST_P(BvhStability, PassesTheSuite) {
    const auto method = tests::make_method("bvh", {{"query", std::string(GetParam())}});
    // The way most used meets most variations.
    const bool usual = GetParam() == std::string("beam");
    const Selection few{{}, usual ? 3 : 1, 1, {1e-4}};
    for (const StressTest& test : suite())
        for (const Light::Type type : test.light_types())
            for (const Scene& scene : test.build(type))
                for (const Variation& variation :
                     variations(few, 1, test.most < 1000 ? 0 : test.most)) {
                    const JudgedScene judged = judge(vary(scene, variation));
                    const Marks marks = tests::answer(*method, judged);
                    EXPECT_TRUE(marks.passed())
                        << test.label() << ' '
                        << (type == Light::Type::point ? "point" : "directional") << ' '
                        << scene.name << ' ' << variation.label() << ": " << marks.score.false_lit
                        << " false lit, " << marks.score.false_shadowed << " false shadowed, "
                        << marks.unexpected << " unexpected";
                }
}

INSTANTIATE_TEST_SUITE_P(Query, BvhStability, testing::Values("beam", "packet", "lane"),
                         [](const auto& query) { return std::string(query.param); });

}  // namespace
