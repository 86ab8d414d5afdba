// Damaged files: whatever bytes change, loading gives a LoadError or a mesh with every guarantee.
#include <cstdlib>

#include "experiments/scenes/shapes.hpp"
#include "tests/experiments/scenes_support.hpp"

namespace experiments::scenes {
namespace {

std::string ply(const std::string& format, bool big) {
    const bool ascii = format == "ascii";
    std::string bytes = "ply\nformat " + format +
                        " 1.0\ncomment x\nelement vertex 20\nproperty float x\nproperty float y\n"
                        "property float z\nproperty uchar red\nelement face 18\n"
                        "property list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 20; ++i) {
        const float x = 0.1f * i, y = 0.01f * i * i, z = i % 3;
        if (ascii)
            bytes += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " 7\n";
        else
            bytes += raw<float>({x, y, z}, big) + raw<std::uint8_t>({7});
    }
    for (int i = 0; i < 18; ++i) {
        const int last = i < 17 ? i + 3 : 0;
        if (ascii)
            bytes += "4 " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
                     std::to_string(i + 2) + " " + std::to_string(last) + "\n";
        else
            bytes += raw<std::uint8_t>({4}) + raw<std::int32_t>({i, i + 1, i + 2, last}, big);
    }
    return bytes;
}

std::string obj() {
    std::string text = "mtllib a.mtl\n";
    for (int i = 0; i < 20; ++i)
        text += "v\t" + std::to_string(0.1 * i) + " " + std::to_string(i % 4) + " -1e-3\nvt 0 1\n";
    for (int i = 1; i < 17; ++i)
        text += "f " + std::to_string(i) + "/1 " + std::to_string(i + 1) + "//2 " +
                std::to_string(-i) + " " + std::to_string(i + 3) + "/1/1\n";
    return text + "l 1 2\nf 1 2 \\\n 3\n";
}

std::string gltf_json(const std::string& uri) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":)"
           R"([1,2],"scale":[2,1,1]},{"mesh":0,"rotation":[0,0,0.6,0.8]},{"mesh":0,"matrix":)"
           R"([1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]}],"meshes":[{"primitives":[{"attributes":)"
           R"({"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"mode":5}]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4},)"
           R"({"bufferView":1,"componentType":5123,"type":"SCALAR","count":6}],"bufferViews":)"
           R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],)"
           R"("buffers":[{"byteLength":60)" +
           uri + "}]}";
}

std::string glb() {
    std::string text = gltf_json("");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string data =
        raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw<std::uint16_t>({0, 1, 2, 0, 2, 3});
    const auto word = [](std::size_t v) {
        return raw<std::uint32_t>({static_cast<std::uint32_t>(v)});
    };
    return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" +
           text + word(data.size()) + std::string("BIN\0", 4) + data;
}

/// One to four changes: bits, bytes, digits, a cut, a piece removed or repeated.
std::string damaged(std::string bytes, Random& random) {
    const std::uint32_t changes = 1 + random.index(4);
    for (std::uint32_t i = 0; i < changes && !bytes.empty(); ++i) {
        const std::size_t at = random.index(static_cast<std::uint32_t>(bytes.size()));
        const std::size_t length = random.index(16);
        switch (random.index(8)) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ 1 << random.index(8));
                break;
            case 1:
                bytes[at] = static_cast<char>(random.next());
                break;
            case 2:
                bytes[at] = static_cast<char>('0' + random.index(10));
                break;
            case 3:
                bytes.insert(at, std::to_string(random.next() >> random.index(64)));
                break;
            case 4:
                bytes.erase(at, length);
                break;
            case 5:
                bytes.insert(at, bytes.substr(at, length));
                break;
            case 6:
                bytes.replace(at, 4, raw<std::uint32_t>({0xffffffffu}));
                break;
            default:
                if (random.index(4) == 0) bytes.resize(at);
        }
    }
    return bytes;
}

struct Original {
    std::string name, bytes;
};
void PrintTo(const Original& original, std::ostream* out) { *out << original.name; }

class DamagedFiles : public SceneFiles, public testing::WithParamInterface<Original> {};

TEST_P(DamagedFiles, GiveAnErrorOrASoundMesh) {
    const char* given = std::getenv("GROVE_TEST_SEED");
    const std::uint64_t seed = given ? std::strtoull(given, nullptr, 10) : 1;
    const auto& [name, original] = GetParam();
    expect_guarantees(load(name, original));
    constexpr int kRuns = 3000;
    int loaded = 0;
    for (int run = 0; run < kRuns; ++run) {
        SCOPED_TRACE(testing::Message()
                     << name << " with GROVE_TEST_SEED=" << seed << ", run " << run);
        Random random(seed * kRuns + static_cast<std::uint64_t>(run));
        const auto path = write(name, damaged(original, random));
        try {
            expect_guarantees(load_mesh(path));
            ++loaded;
        } catch (const LoadError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
        if (HasFatalFailure()) return;
    }
    RecordProperty("loaded", loaded);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, DamagedFiles,
    testing::Values(
        Original{"ascii.ply", ply("ascii", false)},
        Original{"little.ply", ply("binary_little_endian", false)},
        Original{"big.ply", ply("binary_big_endian", true)}, Original{"a.obj", obj()},
        Original{"a.glb", glb()},
        Original{"a.gltf", gltf_json(R"(,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACA)"
                                     R"(PwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA")")},
        Original{"a.ply.gz", gzipped(ply("binary_little_endian", false))},
        Original{"a.obj.gz", gzipped(obj())}),
    [](const auto& param) {
        std::string name = param.param.name;
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });

}  // namespace
}  // namespace experiments::scenes
