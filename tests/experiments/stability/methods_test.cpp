// Exact methods pass the stress suite, in every way to walk their trees.
#include <gtest/gtest.h>

#include "experiments/stability/suite.hpp"
#include "experiments/stability/variations.hpp"
#include "tests/experiments/stability/answer.hpp"

namespace {

using namespace experiments::stability;

struct Way {
    const char* method;
    const char* query;
    bool cull_receivers = false;  ///< metric_tree: leave out what can shadow no point
};

class MethodStability : public tests::GpuTest, public testing::WithParamInterface<Way> {};

TEST_P(MethodStability, PassesTheSuite) {
    std::map<std::string, structures::Value> settings{{"query", std::string(GetParam().query)}};
    if (GetParam().cull_receivers) settings["cull_receivers"] = true;
    const auto method = tests::make_method(GetParam().method, settings);
    // The way most used meets most variations.
    const bool usual = GetParam().query == std::string("beam") && !GetParam().cull_receivers;
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

INSTANTIATE_TEST_SUITE_P(Query, MethodStability,
                         testing::Values(Way{"bvh", "beam"}, Way{"bvh", "packet"},
                                         Way{"bvh", "lane"}, Way{"metric_tree", "beam"},
                                         Way{"metric_tree", "packet"}, Way{"metric_tree", "lane"},
                                         Way{"metric_tree", "stackless"},
                                         Way{"metric_tree", "beam", true}),
                         [](const auto& way) {
                             return std::string(way.param.method) + '_' + way.param.query +
                                    (way.param.cull_receivers ? "_culled" : "");
                         });

}  // namespace
