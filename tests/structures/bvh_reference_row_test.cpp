// The CPU builder behind the registry.
#include <set>

#include "structures/bvh/reference_builder.hpp"
#include "tests/structures/meshes.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace structures {
namespace {

TEST(StructureRegistry, ListsTheReferenceBuilderUnderAUniqueName) {
    std::set<std::string_view> names;
    for (const StructureRow& row : registry()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice";
        EXPECT_FALSE(row.summary.empty()) << row.name;
        EXPECT_EQ(Settings::resolve(row.parameters(), {}).label(), "default") << row.name;
    }
    EXPECT_TRUE(names.contains("bvh_reference"));
}

using BvhReferenceRow = tests::GpuTest;

TEST_F(BvhReferenceRow, BuildsAndRebuilds) {
    const geometry::TriangleMesh mesh = tests::random_triangles(500, 9);
    const StructureRow& row = bvh::kReferenceRow;
    std::set<std::uint64_t> fingerprints;
    for (const std::string rule : {"sweep_sah", "object_median", "spatial_median"}) {
        const auto builder = row.create(
            tests::device(), Settings::resolve(row.parameters(), {{"rule", Value(rule)}}));
        EXPECT_THROW(builder->metrics(), std::logic_error);
        builder->prepare(mesh);
        EXPECT_THROW(builder->fingerprint(), std::logic_error);
        taskpool::pool::run(tests::device(), builder->job());
        EXPECT_TRUE(builder->validate().empty());
        const std::uint64_t fingerprint = builder->fingerprint();
        taskpool::pool::run(tests::device(), builder->job());
        EXPECT_EQ(builder->fingerprint(), fingerprint);
        EXPECT_EQ(builder->metrics().front().metric, "sah_cost");
        fingerprints.insert(fingerprint);
    }
    EXPECT_EQ(fingerprints.size(), 3u);
}

}  // namespace
}  // namespace structures
