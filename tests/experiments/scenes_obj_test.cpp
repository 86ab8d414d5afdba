// OBJ: every form a file may take, and every fault.
#include <fmt/format.h>

#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

using testing::HasSubstr;

class ObjFiles : public SceneFiles {};

TEST_F(ObjFiles, BlanksLineEndsCommentsAndContinuations) {
    const LoadedMesh scene = load("a.obj",
                                  "# a comment\r\nmtllib none.mtl\r\no thing\r\n"
                                  "v\t0 0 0\r\nv 1\t0 0 1.0\r\n  v  0  1  0  0.5 0.5 0.5 \r\n"
                                  "vt 0 0\r\nvn 0 0 1\r\ng side\r\nusemtl red\r\ns off\r\n\r\n"
                                  "f 1/1/1\t2/1/1 3/1/1 # trailing\r\n"
                                  "f 1//1 3//1 \\\r\n  2//1\r\nf 1/1 2/1 3/1");
    EXPECT_EQ(scene.mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 1}, {0, 1, 2}}));
    EXPECT_EQ(scene.report.skipped, 0u);
    EXPECT_EQ(scene.report.duplicates, 2u);
}

TEST_F(ObjFiles, NegativeIndicesCountBackFromTheFace) {
    const LoadedMesh scene = load("a.obj",
                                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
                                  "v 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\nf 1 -1 2\n");
    EXPECT_EQ(scene.mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}, {0, 5, 1}}));
}

TEST_F(ObjFiles, FacesMayComeBeforeTheirVertices) {
    const LoadedMesh scene = load("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    EXPECT_EQ(scene.mesh.triangles[0], glm::uvec3(0, 1, 2));
}

TEST_F(ObjFiles, PolygonsPointsLinesAndCurves) {
    const LoadedMesh scene = load("a.obj.gz", gzipped("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                                      "f 1 2 3 4\np 1 2\nl 1 2\nf 1 2\n"
                                                      "curv 0 1 1 2\nf 1 2 3"));
    EXPECT_EQ(scene.mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
    EXPECT_EQ(scene.report.polygons, 1u);
    EXPECT_EQ(scene.report.skipped, 4u);
}

TEST_F(ObjFiles, RandomPolygonsKeepTheirArea) {
    // Star-shaped polygons around the origin, in a tilted plane: n - 2 triangles, the same area.
    std::uint32_t state = 7;
    const auto random = [&] { return ((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24; };
    for (int n = 4; n < 60; ++n) {
        SCOPED_TRACE(n);
        std::string text = "f";
        for (int i = 1; i <= n; ++i) text += fmt::format(" {}", i);
        double area = 0;
        std::vector<glm::dvec2> corners;
        for (int i = 0; i < n; ++i)
            corners.push_back((0.2 + random()) *
                              glm::dvec2(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n)));
        for (int i = 0; i < n; ++i) {
            const glm::dvec2 a = corners[i], b = corners[(i + 1) % n];
            area += (a.x * b.y - a.y * b.x) / 2;
            text += fmt::format("\nv {:.6f} {:.6f} {:.6f}", a.x, a.y, 0.5 * a.x);
        }
        const LoadedMesh scene = load("a.obj", text + "\n");
        ASSERT_EQ(scene.mesh.triangle_count(), n - 2u);
        double sum = 0;
        for (std::size_t i = 0; i < scene.mesh.triangle_count(); ++i) {
            const glm::dvec3 a = scene.mesh.corner(i, 0), b = scene.mesh.corner(i, 1),
                             c = scene.mesh.corner(i, 2);
            const double z = glm::cross(b - a, c - a).z / 2;
            EXPECT_GE(z, -1e-6);
            sum += z;
        }
        EXPECT_NEAR(sum, area, 1e-5);
    }
}

TEST_F(ObjFiles, Faults) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_THAT(error("a.obj", vertices), HasSubstr("has no triangles (3 vertices)"));
    EXPECT_THAT(error("a.obj", std::string("\x7f\x45LF\0\1\2", 7)), HasSubstr("has no triangles"));
    EXPECT_THAT(error("a.obj", "# nothing\n"), HasSubstr("has no triangles"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 3\nf 1 2 4\n"),
                HasSubstr("line 5: face 2 refers to vertex 4, but there are 3"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 -4\n"),
                HasSubstr("line 4: face 1 refers to vertex -4, with 3 vertices before it"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 0\n"), HasSubstr("refers to vertex 0"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 99999999999\n"), HasSubstr("vertex 99999999999"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 9999999999999999999999\n"),
                HasSubstr("line 4: '9999999999999999999999' is no face corner"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 x\n"), HasSubstr("'x' is no face corner"));
    EXPECT_THAT(error("a.obj", vertices + "f 1 2 3.5\n"), HasSubstr("'3.5' is no face corner"));
    EXPECT_THAT(error("a.obj", "v 0 0\n"), HasSubstr("line 1: '' is no z coordinate"));
    EXPECT_THAT(error("a.obj", "v 0 1,5 0\n"), HasSubstr("line 1: '1,5' is no y coordinate"));
    EXPECT_THAT(error("a.obj", vertices + "v nan 0 0\nf 1 2 3\n"), HasSubstr("vertex 3 (counted"));
    EXPECT_THAT(error("a.obj", vertices + "v 0 1e39 0\nf 1 2 3\n"), HasSubstr("has inf as its y"));
    EXPECT_THAT(error("a.obj", vertices + "v 0 1e30 0\nf 1 2 3\n"),
                HasSubstr("scale the mesh down"));
}

}  // namespace
}  // namespace experiments::scenes
