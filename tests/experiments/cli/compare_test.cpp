// grove compare.
#include <gmock/gmock.h>

#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

using testing::HasSubstr;

class CompareTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        write_config();
        ASSERT_EQ(fake("run test.toml --quiet --out a").code, 0);
        ASSERT_EQ(fake("run test.toml --quiet --out b --set method.0.variant=default "
                       "--set method.0.scale=2.0")
                      .code,
                  0);
    }
};

TEST_F(CompareTest, ARunEqualsItself) {
    const Outcome same = fake("compare a a --fail-over 0");
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_THAT(same.out, HasSubstr("query_ms"));
}

TEST_F(CompareTest, WorseBeyondTheLimitFails) {
    const Outcome plain = fake("compare a b");
    EXPECT_EQ(plain.code, 0);
    EXPECT_THAT(plain.out, HasSubstr("+100.0 %"));
    expect_error(fake("compare a b --fail-over 50"), 1, {"worse", "50 %"});
    const Outcome better = fake("compare b a --fail-over 0");
    EXPECT_EQ(better.code, 0) << better.err;
    EXPECT_THAT(better.out, HasSubstr("-50.0 %"));
}

TEST_F(CompareTest, MissingRunsAndRows) {
    expect_error(fake("compare a none"), 1, {"none/summary.json"});
    write_text(folder_ / "b/summary.json", "{\"schema\": 1, \"results\": []}");
    expect_error(fake("compare a b --fail-over 1000"), 1, {"worse"});
    write_text(folder_ / "b/summary.json", "[1, 2");
    expect_error(fake("compare a b"), 1, {"b/summary.json"});
}

}  // namespace
}  // namespace tests
