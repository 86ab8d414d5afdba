// Real scenes against their table: the folder $GROVE_SCENES with SCENES.csv, views.json and the
// files these name. Skipped where the variable is not set.
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/scenes/views_file.hpp"
#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

std::filesystem::path scene_folder() {
    const char* folder = std::getenv("GROVE_SCENES");
    return folder ? folder : "";
}

#define REQUIRE_SCENES() \
    if (scene_folder().empty()) GTEST_SKIP() << "GROVE_SCENES is not set: NO REAL SCENE IS TESTED"

/// Fields of one CSV line; a field may be quoted, with "" for a quote.
std::vector<std::string> fields(const std::string& line) {
    std::vector<std::string> result(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            result.emplace_back();
        else
            result.back() += line[i];
    }
    return result;
}

TEST(RealScenes, CountsAndBoundsAreThoseOfTheTable) {
    REQUIRE_SCENES();
    std::ifstream table(scene_folder() / "SCENES.csv");
    ASSERT_TRUE(table);
    std::string line;
    std::getline(table, line);
    const std::vector<std::string> names = fields(line);
    int files = 0;
    while (std::getline(table, line)) {
        const std::vector<std::string> values = fields(line);
        ASSERT_EQ(values.size(), names.size()) << line;
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
        SCOPED_TRACE(row["file"]);
        const auto number = [&](const char* name) { return std::stoull(row.at(name)); };

        const LoadedMesh scene = load_mesh(scene_folder() / row["file"]);
        expect_guarantees(scene);
        EXPECT_EQ(scene.report.triangles, number("triangles"));
        EXPECT_EQ(scene.report.vertices, number("vertices"));
        EXPECT_EQ(scene.report.duplicates, number("duplicate_triangles"));
        // The table counts areas of 0 after rounding, TriangleMesh exact ones.
        EXPECT_GE(scene.report.degenerate, number("degenerate_index"));
        EXPECT_LE(scene.report.degenerate, number("degenerate_index") + number("degenerate_area"));
        EXPECT_EQ(scene.report.skipped, 0u);

        const structures::geometry::Aabb box = scene.mesh.bounds();
        std::istringstream corners(row["bbox"]);  // rounded to 6 digits
        for (const glm::vec3 corner : {box.lower, box.upper})
            for (int axis = 0; axis < 3; ++axis) {
                float expected = 0;
                corners >> expected;
                EXPECT_NEAR(corner[axis], expected, 1e-5 * std::abs(expected) + 1e-6);
            }
        ++files;
    }
    EXPECT_GE(files, 20);
}

TEST(RealScenes, EveryViewLoads) {
    REQUIRE_SCENES();
    const auto path = scene_folder() / "views.json";
    const auto root = nlohmann::json::parse(std::ifstream(path));
    int views = 0;
    for (const auto& [file, scene] : root["scenes"].items())
        for (const auto& [name, description] : scene["views"].items()) {
            SCOPED_TRACE(file + ", " + name);
            const View view = load_view(path, scene_folder() / file, name);
            EXPECT_EQ(view.camera.fault(), "");
            EXPECT_EQ(view.camera.eye.y, description["camera"]["eye"][1].get<float>());
            ++views;
        }
    EXPECT_GE(views, 20);
}

}  // namespace
}  // namespace experiments::scenes
