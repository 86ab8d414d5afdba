// glTF and GLB: every form of primitive, node and accessor, and every fault.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kFloat = 5126, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125;

/// Puts a glTF file together: one buffer, filled by `add`.
struct Builder {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
    std::string bytes;

    /// A buffer view and an accessor for `data`; returns the accessor.
    std::size_t add(const std::string& data, int component_type, const std::string& type,
                    std::size_t count) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data;
        root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"type", type},
                                     {"count", count}});
        return root["accessors"].size() - 1;
    }

    json text() {
        json result = root;
        result["buffers"] = json::array({{{"byteLength", bytes.size()}}});
        return result;
    }

    std::string gltf(const std::string& uri) {
        json result = text();
        result["buffers"][0]["uri"] = uri;
        return result.dump();
    }

    std::string glb() {
        std::string json_chunk = text().dump();
        json_chunk.resize((json_chunk.size() + 3) / 4 * 4, ' ');
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) {
            return raw<std::uint32_t>({static_cast<std::uint32_t>(value)});
        };
        return "glTF" + word(2) + word(28 + json_chunk.size() + bytes.size()) +
               word(json_chunk.size()) + "JSON" + json_chunk + word(bytes.size()) +
               std::string("BIN\0", 4) + bytes;
    }
};

const std::string kSquare = raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});

/// One node with a mesh of one triangle list on four corners.
Builder square() {
    Builder builder;
    const std::size_t positions = builder.add(kSquare, kFloat, "VEC3", 4);
    const std::size_t indices =
        builder.add(raw<std::uint16_t>({0, 1, 2, 0, 2, 3}), kUnsignedShort, "SCALAR", 6);
    builder.root["meshes"] = json::array(
        {{{"primitives",
           json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}}});
    builder.root["nodes"] = json::array({{{"mesh", 0}}});
    builder.root["scenes"] = json::array({{{"nodes", {0}}}});
    return builder;
}

std::string base64(const std::string& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? bytes[i + k] & 0xff : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
    return text;
}

class GltfFiles : public SceneFiles {};

TEST_F(GltfFiles, BinaryTextDataUriAndFileAreTheSameMesh) {
    Builder builder = square();
    const LoadedMesh glb = load("a.glb", builder.glb());
    expect_guarantees(glb);
    EXPECT_EQ(glb.mesh.positions,
              (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(glb.mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));

    write("my data.bin", builder.bytes);
    const std::string data_uri = "data:application/octet-stream;base64," + base64(builder.bytes);
    for (const LoadedMesh& other : {load("a.gltf", builder.gltf(data_uri)),
                                    load("a.gltf.gz", gzipped(builder.gltf(data_uri))),
                                    load("b.gltf", builder.gltf("my%20data.bin")),
                                    load("a.glb.gz", gzipped(builder.glb()))}) {
        EXPECT_EQ(other.mesh.positions, glb.mesh.positions);
        EXPECT_EQ(other.mesh.triangles, glb.mesh.triangles);
    }
}

TEST_F(GltfFiles, EveryIndexType) {
    for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
        Builder builder = square();
        const std::string bytes = type == kUnsignedByte    ? raw<std::uint8_t>({3, 2, 1})
                                  : type == kUnsignedShort ? raw<std::uint16_t>({3, 2, 1})
                                                           : raw<std::uint32_t>({3, 2, 1});
        builder.root["meshes"][0]["primitives"][0]["indices"] =
            builder.add(bytes, type, "SCALAR", 3);
        EXPECT_EQ(load("a.glb", builder.glb()).mesh.triangles[0], glm::uvec3(3, 2, 1));
    }
}

TEST_F(GltfFiles, StripsFansListsPointsAndLines) {
    const auto triangles = [&](json primitive) {
        Builder builder = square();
        json& target = builder.root["meshes"][0]["primitives"][0];
        target.erase("indices");
        target.update(primitive);
        return load("a.glb", builder.glb()).mesh.triangles;
    };
    using List = std::vector<glm::uvec3>;
    EXPECT_EQ(triangles({{"mode", 4}}), (List{{0, 1, 2}}));  // the fourth vertex is left over
    EXPECT_EQ(triangles({{"mode", 5}}), (List{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(triangles({{"mode", 6}}), (List{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(triangles({{"mode", 5}, {"indices", 1}}),
              (List{{0, 1, 2}, {1, 0, 2}, {2, 0, 2}, {0, 3, 2}}));

    Builder builder = square();
    json& primitives = builder.root["meshes"][0]["primitives"];
    for (const int mode : {0, 1, 2, 3}) {
        primitives.push_back(primitives[0]);
        primitives.back()["mode"] = mode;
    }
    primitives.push_back(primitives[0]);  // shares its positions with the first
    const LoadedMesh scene = load("a.glb", builder.glb());
    EXPECT_EQ(scene.report.skipped, 4u);
    EXPECT_EQ(scene.report.triangles, 4u);
    EXPECT_EQ(scene.report.vertices, 4u);
    EXPECT_EQ(scene.report.duplicates, 2u);
}

TEST_F(GltfFiles, NodeTransformsNest) {
    Builder builder = square();
    const double half = std::sqrt(0.5);
    builder.root["nodes"] =
        json::array({{{"children", {1, 2}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
                     // A quarter turn around z.
                     {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"translation", {0, 0, 1}}},
                     {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}});
    const LoadedMesh scene = load("a.glb", builder.glb());
    ASSERT_EQ(scene.mesh.positions.size(), 8u);
    const std::vector<glm::vec3> expected = {{10, 0, 2},  {10, 2, 2}, {8, 2, 2},  {8, 0, 2},
                                             {10, 0, 10}, {8, 0, 10}, {8, 2, 10}, {10, 2, 10}};
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_LT(glm::distance(scene.mesh.positions[i], expected[i]), 1e-5f) << i;
    // The mirrored copy keeps its front side: both face +z.
    EXPECT_EQ(scene.mesh.triangles[2], glm::uvec3(4, 6, 5));
    for (std::size_t i = 0; i < scene.mesh.triangle_count(); ++i)
        EXPECT_GT(glm::cross(scene.mesh.corner(i, 1) - scene.mesh.corner(i, 0),
                             scene.mesh.corner(i, 2) - scene.mesh.corner(i, 0))
                      .z,
                  0);
}

TEST_F(GltfFiles, OnlyTheDefaultSceneOrElseTheRoots) {
    Builder builder = square();
    builder.root["nodes"] =
        json::array({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {7, 0, 0}}, {"children", {0}}}});
    builder.root["scenes"] = json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
    builder.root["scene"] = 1;
    EXPECT_EQ(load("a.glb", builder.glb()).mesh.positions[0].x, 7);
    builder.root["scene"] = 0;
    EXPECT_EQ(load("a.glb", builder.glb()).report.triangles, 2u);
    builder.root.erase("scenes");
    builder.root.erase("scene");
    EXPECT_EQ(load("a.glb", builder.glb()).report.triangles, 4u);
}

TEST_F(GltfFiles, QuantizedStridedAndSparsePositions) {
    Builder builder = square();
    // Normalised shorts, 8 bytes apart, from byte 2 of the view.
    const std::size_t shorts =
        builder.add(raw<std::int16_t>({9, 32767, 0, -32767, 9, -32768, 0, 0, 9, 0, 32767, 0, 9}),
                    kShort, "VEC3", 3);
    builder.root["accessors"][shorts].update({{"normalized", true}, {"byteOffset", 2}});
    builder.root["bufferViews"].back()["byteStride"] = 8;
    json& primitive = builder.root["meshes"][0]["primitives"][0];
    primitive = {{"attributes", {{"POSITION", shorts}}}};
    EXPECT_EQ(load("a.glb", builder.glb()).mesh.positions,
              (std::vector<glm::vec3>{{1, 0, -1}, {-1, 0, 0}, {0, 1, 0}}));

    const std::size_t index = builder.add(raw<std::uint8_t>({2}), kUnsignedByte, "SCALAR", 1);
    const std::size_t value = builder.add(raw<float>({5, 6, 7}), kFloat, "VEC3", 1);
    builder.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices",
         {{"bufferView", builder.root["accessors"][index]["bufferView"]},
          {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", builder.root["accessors"][value]["bufferView"]}}}};
    primitive = {{"attributes", {{"POSITION", 0}}}};
    EXPECT_EQ(load("a.glb", builder.glb()).mesh.positions[2], glm::vec3(5, 6, 7));
    builder.root["accessors"][0]["count"] = 2;
    EXPECT_THAT(error("a.glb", builder.glb()), HasSubstr("replaces element 2 of 2"));
}

TEST_F(GltfFiles, Faults) {
    // Each entry changes a valid file: the JSON pointer, the new value, part of the message.
    const std::tuple<const char*, json, const char*> cases[] = {
        {"/asset", json(), "malformed glTF"},
        {"/asset/version", "1.0", "glTF version '1.0' is not 2"},
        {"/scenes/0/nodes/0", 9, "refers to item 9 of 'nodes', which has 1"},
        {"/scenes/0/nodes/0", -1, "scene node is not a natural number"},
        {"/scenes/0/nodes", json::array(), "has no triangles"},
        {"/nodes/0/mesh", 3, "refers to item 3 of 'meshes'"},
        {"/nodes/0/mesh", "0", "node.mesh is not a natural number"},
        {"/nodes/0/children", {0}, "node 0 has two parents or is its own ancestor"},
        {"/nodes/0/scale", {1, 2}, "'scale' is not a list of 3 numbers"},
        {"/nodes/0/translation", {0, 0, 1e300}, "as its z coordinate"},
        {"/meshes/0/primitives/0/mode", 1, "has no triangles"},
        {"/meshes/0/primitives/0/indices", 7, "refers to item 7 of 'accessors'"},
        {"/meshes/0/primitives/0/indices", 0, "accessor 0 is not of type SCALAR"},
        {"/accessors/0/count", 5, "accessor 0 of 5 elements"},
        {"/accessors/0/count", 3, "refers to vertex 3 of a primitive that has 3"},
        {"/accessors/0/count", 9e15, "not a natural number"},
        {"/accessors/0/count", 9000000000000000, "does not fit buffer view 0"},
        {"/accessors/0/byteOffset", 4, "does not fit buffer view 0"},
        {"/accessors/0/componentType", 5130, "component type 5130 is unknown"},
        {"/accessors/0/bufferView", 4, "refers to item 4 of 'bufferViews'"},
        {"/bufferViews/0/byteStride", 4, "does not fit buffer view 0"},
        {"/bufferViews/0/byteOffset", 9000, "does not fit buffer view 0"},
        {"/bufferViews/0/buffer", 1, "refers to item 1 of 'buffers'"},
        {"/buffers/0/byteLength", 4000000000, "buffer 0 is truncated: 60 of 4000000000"},
        {"/buffers/0/uri", "none.bin", "none.bin) no such file"},
        {"/extensionsRequired", {"KHR_draco_mesh_compression"}, "KHR_draco_mesh_compression"},
    };
    for (const auto& [pointer, value, message] : cases) {
        SCOPED_TRACE(fmt::format("{} = {}", pointer, value.dump()));
        Builder builder = square();
        json root = builder.text();
        root["buffers"][0]["uri"] = "data:;base64," + base64(builder.bytes);
        root[json::json_pointer(pointer)] = value;
        EXPECT_THAT(error("a.gltf", root.dump()), HasSubstr(message));
    }
    EXPECT_THAT(error("a.gltf", "{ \"asset\": "), HasSubstr("malformed glTF"));
    EXPECT_THAT(error("a.gltf", "[]"), HasSubstr("it has no 'asset'"));
    EXPECT_THAT(error("a.gltf", square().text().dump()),
                HasSubstr("neither a uri nor a GLB chunk"));
    EXPECT_THAT(error("a.gltf", square().gltf("data:;base64,AA*A")), HasSubstr("base64"));
    EXPECT_THAT(error("a.gltf", std::string(100000, '[')), HasSubstr("malformed glTF"));
}

TEST_F(GltfFiles, FaultsInTheContainer) {
    const std::string whole = square().glb();
    for (std::size_t size = 1; size < whole.size(); ++size) error("a.glb", whole.substr(0, size));
    EXPECT_THAT(error("a.glb", whole.substr(0, whole.size() - 1)), HasSubstr("GLB is truncated"));
    std::string version = whole;
    version[4] = 1;
    EXPECT_THAT(error("a.glb", version), HasSubstr("GLB version 1 is not 2"));
    std::string chunk = whole;
    chunk[15] = 0x7f;
    EXPECT_THAT(error("a.glb", chunk), HasSubstr("GLB chunk at byte 12"));
    std::string no_json = whole;
    no_json[16] = 'X';
    EXPECT_THAT(error("a.glb", no_json), HasSubstr("GLB has no JSON chunk"));
}

TEST_F(GltfFiles, LongChainsOfNodes) {
    Builder builder = square();
    json nodes = json::array();
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i)
        nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    nodes.push_back({{"mesh", 0}});
    builder.root["nodes"] = nodes;
    EXPECT_EQ(load("a.glb", builder.glb()).mesh.positions[0].x, kCount);
}

}  // namespace
}  // namespace experiments::scenes
