// PLY: every form a file may take, and every fault.
#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

using testing::HasSubstr;

const std::string kFloats = "property float x\nproperty float y\nproperty float z\n";

std::string header(const std::string& format, std::size_t vertices, std::size_t faces,
                   const std::string& vertex_properties = kFloats) {
    return "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " +
           std::to_string(vertices) + "\n" + vertex_properties + "element face " +
           std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_tetrahedron(bool big) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian", 4, 4);
    bytes += raw<float>({0, 0, 0, 1.5f, 0, 0, 0, 2.5f, 0, 0, 0, -3.25f}, big);
    for (const auto& f : {std::array{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}})
        bytes += raw<std::uint8_t>({3}) + raw<std::int32_t>({f[0], f[1], f[2]}, big);
    return bytes;
}

const std::string kAsciiTriangle = header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

class PlyFiles : public SceneFiles {};

TEST_F(PlyFiles, BinaryOfBothByteOrdersIsTheSameMesh) {
    const LoadedMesh little = load("a.ply", binary_tetrahedron(false));
    const LoadedMesh big = load("b.PLY", binary_tetrahedron(true));
    expect_guarantees(little);
    EXPECT_EQ(little.mesh.positions, big.mesh.positions);
    EXPECT_EQ(little.mesh.triangles, big.mesh.triangles);
    ASSERT_EQ(little.mesh.triangle_count(), 4u);
    EXPECT_EQ(little.mesh.positions[3], glm::vec3(0, 0, -3.25f));
    EXPECT_EQ(little.mesh.triangles[3], glm::uvec3(1, 2, 3));
}

TEST_F(PlyFiles, GzippedIsTheSameMesh) {
    const std::string bytes = binary_tetrahedron(false);
    const LoadedMesh plain = load("a.ply", bytes), packed = load("a.ply.gz", gzipped(bytes));
    EXPECT_EQ(plain.mesh.positions, packed.mesh.positions);
    EXPECT_EQ(plain.mesh.triangles, packed.mesh.triangles);
    // A gzip file may have several members.
    const LoadedMesh twice =
        load("b.ply.gz", gzipped(bytes.substr(0, 100)) + gzipped(bytes.substr(100)));
    EXPECT_EQ(plain.mesh.triangles, twice.mesh.triangles);
}

TEST_F(PlyFiles, BodyMayStartWithALineEnd) {
    // 0x0A and 0x0D as the first body byte, with each kind of line end in the header.
    for (const std::string line_end : {"\n", "\r\n", "\r"})
        for (const char first : {'\n', '\r'}) {
            std::string head;
            for (const char c : header("binary_little_endian", 3, 1))
                head += c == '\n' ? line_end : std::string(1, c);
            std::string body = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
            body[0] = first;
            body += raw<std::uint8_t>({3}) + raw<std::int32_t>({0, 1, 2});
            const LoadedMesh scene = load("a.ply", head + body);
            EXPECT_EQ(scene.mesh.positions[1], glm::vec3(1, 0, 0));
            EXPECT_EQ(scene.mesh.triangles[0], glm::uvec3(0, 1, 2));
        }
}

TEST_F(PlyFiles, AsciiWithExtraPropertiesElementsAndAnyBlanks) {
    const LoadedMesh scene = load(
        "a.ply",
        "ply\nformat ascii 1.0\nobj_info none\nelement material 1\nproperty list uchar int ids\n"
        "element vertex 3\nproperty uchar red\nproperty double z\nproperty float32 y\n"
        "property list uchar float weights\nproperty float x\nelement face 1\nproperty float cost\n"
        "property list uint8 uint32 vertex_index\nproperty uchar flag\nend_header\n"
        "2 7 8\n255 +1e0 2 1 9 3\n\t1 4 5 2 9 9 6\r\n0 7 8 0 -9.5e-1\n0.5 3 2 1 0 4");
    EXPECT_EQ(scene.mesh.positions[0], glm::vec3(3, 2, 1));
    EXPECT_EQ(scene.mesh.positions[1], glm::vec3(6, 5, 4));
    EXPECT_EQ(scene.mesh.positions[2], glm::vec3(-0.95f, 8, 7));
    EXPECT_EQ(scene.mesh.triangles[0], glm::uvec3(2, 1, 0));
    EXPECT_EQ(scene.report.skipped, 1u);
}

TEST_F(PlyFiles, NumbersAreRoundedOnceToTheNearestFloat) {
    const LoadedMesh scene = load(
        "a.ply", header("ascii", 3, 1) + "16777217.000000001 0.1 1e-50\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(scene.mesh.positions[0], glm::vec3(16777218.f, 0.1f, 0));
}

TEST_F(PlyFiles, PolygonsAreCutAndCounted) {
    const LoadedMesh scene =
        load("a.ply", header("ascii", 5, 4) +
                          "0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n5 0 1 2 3 4\n2 0 1\n3 0 1 2\n0\n");
    EXPECT_EQ(scene.report.triangles, 4u);
    EXPECT_EQ(scene.report.polygons, 1u);
    EXPECT_EQ(scene.report.skipped, 2u);
    // The concave polygon's triangles cover its area, all turned the same way.
    double area = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a = scene.mesh.corner(i, 0), b = scene.mesh.corner(i, 1),
                         c = scene.mesh.corner(i, 2);
        const double z = glm::cross(b - a, c - a).z / 2;
        EXPECT_GT(z, 0);
        area += z;
    }
    EXPECT_DOUBLE_EQ(area, 2.5);
}

TEST_F(PlyFiles, CountsDegenerateAndDuplicateTriangles) {
    const LoadedMesh scene = load("a.ply", header("ascii", 6, 7) +
                                               "0 0 0\n1 0 0\n0 1 0\n2 0 0\n0 0 0\n0 1 0\n"
                                               "3 0 1 2\n3 1 2 0\n3 2 1 0\n3 4 1 5\n"  // the same
                                               "3 0 1 3\n3 0 0 1\n3 0 4 1\n");         // no area
    EXPECT_EQ(scene.report.triangles, 7u);
    EXPECT_EQ(scene.report.degenerate, 3u);
    EXPECT_EQ(scene.report.duplicates, 4u);  // of the first; and 0 0 1, bit by bit, of 0 4 1
}

TEST_F(PlyFiles, FaultsInTheHeader) {
    EXPECT_THAT(error("a.ply", "solid cube\nfacet"), HasSubstr("first line is not 'ply'"));
    EXPECT_THAT(error("a.ply", std::string("ply\0x", 5)), HasSubstr("first line is not 'ply'"));
    EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"),
                HasSubstr("ends in line 4 without end_header"));
    EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n"),
                HasSubstr("line 3: '-3' is no element count"));
    EXPECT_THAT(error("a.ply", "ply\nelement vertex 3\nproperty half x\nend_header\n"),
                HasSubstr("line 3: unknown type 'half'"));
    EXPECT_THAT(error("a.ply", "ply\r\nformat ascii 1.0\r\nel\nement vertex 3\r\n"),
                HasSubstr("cannot read 'el?ement'"));
    EXPECT_THAT(error("a.ply", header("binary_middle_endian", 3, 1)),
                HasSubstr("PLY format 'binary_middle_endian' is none of"));
    EXPECT_THAT(error("a.ply", header("ascii", 1, 1, "property float x\nproperty float y\n") +
                                   "0 0 0 0 0 0 0 0 0"),
                HasSubstr("no property 'z'"));
    EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + kFloats +
                                   "element face 1\nproperty int i\nend_header\n0 0 0\n0\n"),
                HasSubstr("no list 'vertex_indices'"));
}

TEST_F(PlyFiles, AbsurdCountsAreRefusedBeforeAllocating) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        EXPECT_THAT(error("a.ply", header(format, 4'000'000'000'000, 1) + "0 0 0 0 0 0 0 0"),
                    HasSubstr("announces 4000000000000 vertex elements"));
        EXPECT_THAT(error("a.ply", header(format, 0, 9'999'999'999'999'999) + "0 0 0 0 0 0 0 0"),
                    HasSubstr("announces 9999999999999999 face elements"));
    }
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0 1 0 0 0 1 0 4000000000 1 2"),
                HasSubstr("face 0 has a list of"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0 1 0 0 0 1 0 -1 1 2"),
                HasSubstr("face 0 has a list of -1 values"));
}

TEST_F(PlyFiles, EveryTruncationIsNamed) {
    for (const std::string& whole :
         {binary_tetrahedron(false), binary_tetrahedron(true), kAsciiTriangle}) {
        // Without the last line end an ASCII file is still complete.
        const std::size_t complete = whole.size() - (whole == kAsciiTriangle);
        for (std::size_t size = 1; size < complete; ++size) error("a.ply", whole.substr(0, size));
    }
    const std::string whole = binary_tetrahedron(false);
    EXPECT_THAT(error("a.ply", whole.substr(0, whole.size() - 1)),
                HasSubstr("face 3 has a list of 3 values, with 11 bytes left: truncated"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 "),
                HasSubstr("only 16 bytes are left, enough for 2"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0.0000 0 0\n1 0 0\n0 1 "),
                HasSubstr("ends inside vertex 2 of 3"));
}

TEST_F(PlyFiles, FaultsInTheBody) {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_THAT(error("a.ply", header("ascii", 3, 2) + vertices + "3 0 1 2\n3 0 1 3\n"),
                HasSubstr("face 1 refers to vertex 3, but 3 vertices"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + vertices + "3 0 -1 2\n"),
                HasSubstr("face 0 refers to vertex -1"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2"),
                HasSubstr("byte 10 of the PLY body is no number"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2"),
                HasSubstr("vertex 1 (counted from 0) has nan as its y coordinate"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 -inf\n3 0 1 2"),
                HasSubstr("vertex 2 (counted from 0) has -inf as its z coordinate"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "1e99 0 0\n1 0 0\n0 1 0\n3 0 1 2"),
                HasSubstr("has inf as its x coordinate"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 1) + "2e18 0 0\n1 0 0\n0 1 0\n3 0 1 2"),
                HasSubstr("beyond +-1e+18: scale the mesh down"));
    EXPECT_THAT(error("a.ply", header("ascii", 3, 0) + vertices),
                HasSubstr("has no triangles (3 vertices)"));
    const std::string faces_first =
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int "
        "vertex_indices\nelement vertex 3\n" +
        kFloats + "end_header\n3 0 1 2\n" + vertices;
    EXPECT_THAT(error("a.ply", faces_first),
                HasSubstr("face 0 refers to vertex 0, but 0 vertices"));
}

TEST_F(PlyFiles, FaultsInTheFile) {
    EXPECT_THAT(error_at(folder_ / "none.ply"), HasSubstr("no such file"));
    EXPECT_THAT(error_at(folder_ / "no folder" / "a.ply"), HasSubstr("no such file"));
    std::filesystem::create_directory(folder_ / "folder.ply");
    EXPECT_THAT(error_at(folder_ / "folder.ply"), HasSubstr("is a folder"));
    EXPECT_THAT(error("a.ply", ""), HasSubstr("is empty"));
    for (const char* name : {"a.stl", "a", "a.gz", "a.ply.zip", "ply"})
        EXPECT_THAT(error(name, kAsciiTriangle), HasSubstr("known: .ply .obj .gltf .glb"));
    if (geteuid() != 0) {
        const auto path = write("locked.ply", kAsciiTriangle);
        std::filesystem::permissions(path, std::filesystem::perms::none);
        EXPECT_THAT(error_at(path), HasSubstr("cannot be opened: Permission denied"));
    }
}

TEST_F(PlyFiles, FaultsInTheGzipData) {
    const std::string packed = gzipped(binary_tetrahedron(false));
    EXPECT_THAT(error("a.ply.gz", kAsciiTriangle), HasSubstr("gzip data is corrupt at byte"));
    EXPECT_THAT(error("a.ply.gz", packed.substr(0, packed.size() / 2)),
                HasSubstr("gzip data ends early"));
    EXPECT_THAT(error("a.ply.gz", packed.substr(0, packed.size() - 1)),
                HasSubstr("gzip data ends early"));
    EXPECT_THAT(error("a.ply.gz", packed + "more"), HasSubstr("gzip data is corrupt"));
    std::string wrong_checksum = packed;
    wrong_checksum[packed.size() - 8] ^= 1;
    EXPECT_THAT(error("a.ply.gz", wrong_checksum), HasSubstr("incorrect data check"));
}

TEST_F(PlyFiles, ManyIdenticalTriangles) {
    std::string bytes = header("ascii", 3, 100000) + "0 0 0\n1 0 0\n0 1 0\n";
    for (int i = 0; i < 100000; ++i) bytes += "3 0 1 2\n";
    EXPECT_EQ(load("a.ply", bytes).report.duplicates, 99999u);
}

}  // namespace
}  // namespace experiments::scenes
