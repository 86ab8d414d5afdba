// The registry of shadow methods.
#include <gtest/gtest.h>

#include <set>

#include "shadows/method.hpp"

namespace shadows {
namespace {

TEST(MethodRegistry, ListsEveryMethodOnce) {
    std::set<std::string_view> names;
    for (const MethodRow& row : registry()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice";
        EXPECT_FALSE(row.summary.empty()) << row.name;
        EXPECT_EQ(structures::Settings::resolve(row.parameters(), {}).label(), "default")
            << row.name;
    }
    for (const char* name : {"embree", "embree_packet", "embree_stream"})
        EXPECT_TRUE(names.contains(name)) << name;
}

}  // namespace
}  // namespace shadows
