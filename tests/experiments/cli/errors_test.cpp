// Bad command lines, configs and scenes, as the delivered program reports them.
#include <unistd.h>

#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

namespace fs = std::filesystem;

class ErrorsTest : public CliTest {
  protected:
    /// A config whose [[scene]] is `file`, run by the delivered program.
    Outcome run_scene(const std::string& file) {
        write_text(folder_ / "scene.toml",
                   "[experiment]\nkind = \"shadows\"\nrepeat = 1\n[[scene]]\nfile = \"" + file +
                       "\"\nresolution = [32, 32]\n[[method]]\nname = \"embree\"\n");
        fs::remove_all(folder_ / "r");
        return real("run scene.toml --out r");
    }
    Outcome run_text(const std::string& text) {
        write_text(folder_ / "x.toml", text);
        return real("run x.toml --out r");
    }
};

TEST_F(ErrorsTest, CommandLine) {
    expect_error(real(""), 2, {"subcommand"});
    expect_error(real("rum"), 2, {"unknown command 'rum'", "did you mean 'run'"});
    expect_error(real("run"), 2, {"CONFIG"});
    expect_error(real("run x.toml --devise 1"), 2, {"--devise"});
    expect_error(real("list shadow"), 2, {"shadow", "did you mean 'shadows'"});
    expect_error(real("run x.toml --resume"), 2, {"--resume needs --out"});
    EXPECT_EQ(real("--help").code, 0);
}

TEST_F(ErrorsTest, ConfigFile) {
    expect_error(real("run none.toml"), 2, {"none.toml", "cannot be opened"});
    expect_error(run_text("[experiment\nname = 1\n"), 2, {"x.toml:1:"});
    expect_error(run_text("[experiment]\nkind = \"shadows\"\nrepat = 3\n"), 2,
                 {"x.toml:3:", "unknown key 'repat'", "did you mean 'repeat'"});
    expect_error(run_text("[experiment]\nkind = \"shadows\"\nrepeat = \"3\"\n"), 2,
                 {"x.toml:3:", "'repeat' is a string", "expected an integer"});
    expect_error(run_text("[experiment]\nkind = \"trace\"\n"), 2,
                 {"x.toml:2:", "not available in this version", "shadows, build"});
    expect_error(run_text("[experiment]\nkind = \"shadows\"\n[[scene]]\ngenerator = \"citty\"\n"),
                 2, {"x.toml:4:", "'citty'", "did you mean 'city'"});
    expect_error(run_text("[experiment]\nkind = \"shadows\"\n[[scene]]\ngenerator = \"city\"\n"
                          "[[method]]\nname = \"embre\"\n"),
                 2, {"x.toml:6:", "'embre'", "did you mean 'embree'"});
    expect_error(run_text("[experiment]\nkind = \"shadows\"\n[[scene]]\nresolution = [64, 64]\n"
                          "[[method]]\nname = \"embree\"\n"),
                 2, {"x.toml:3:", "'file' or 'generator'"});
    EXPECT_FALSE(fs::exists(folder_ / "r")) << "no work before the config is checked";
}

TEST_F(ErrorsTest, SceneFiles) {
    expect_error(run_scene("none.ply"), 2, {"scene.toml:5:", "none.ply", "does not exist"});
    write_text(folder_ / "text.ply", "this is no mesh\n");
    expect_error(run_scene("text.ply"), 1, {"text.ply"});
    write_text(folder_ / "mesh.xyz", "1 2 3\n");
    expect_error(run_scene("mesh.xyz"), 1, {"mesh.xyz"});
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    write_text(folder_ / "cut.ply", header + "0 0 0\n1 0 0\n");
    expect_error(run_scene("cut.ply"), 1, {"cut.ply"});
    write_text(folder_ / "empty.obj", "v 0 0 0\nv 1 0 0\n");
    expect_error(run_scene("empty.obj"), 1, {"empty.obj", "triangle"});
    write_text(folder_ / "nan.ply", header + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n");
    expect_error(run_scene("nan.ply"), 1, {"nan.ply"});
    write_text(folder_ / "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    expect_error(run_scene("range.obj"), 1, {"range.obj"});
    EXPECT_EQ(json("r/manifest.json").at("sessions")[0].at("exit"), 1);
}

TEST_F(ErrorsTest, ABrokenSceneStopsNoOther) {
    write_text(folder_ / "bad.ply", "no mesh");
    write_text(folder_ / "x.toml",
               "[experiment]\nkind = \"shadows\"\nrepeat = 1\n[[scene]]\nfile = \"bad.ply\"\n"
               "[[scene]]\ngenerator = \"city\"\ntriangles = 1000\nresolution = [32, 32]\n"
               "[[method]]\nname = \"embree\"\n");
    expect_error(real("run x.toml --out r"), 1, {"bad.ply"});
    EXPECT_EQ(json("r/summary.json").at("results").size(), 2u);
}

TEST_F(ErrorsTest, OutputFolder) {
    write_config();
    expect_error(fake("run test.toml --out test.toml"), 2, {"--out", "test.toml"});
    expect_error(fake("run test.toml --out /proc/grove"), 2, {"--out", "/proc/grove"});
}

TEST_F(ErrorsTest, NoVulkanDevice) {
    write_config();
    write_text(folder_ / "none.json", "{}");
    const std::string none = "VK_DRIVER_FILES=none.json VK_ICD_FILENAMES=none.json";
    expect_error(fake("run test.toml --out r", none), 1, {"no Vulkan device", "grove doctor"});
    expect_error(fake("doctor", none), 1, {"no usable Vulkan device"});
    EXPECT_FALSE(fs::exists(folder_ / "r"));
}

TEST_F(ErrorsTest, DeviceIndex) {
    write_config();
    expect_error(fake("run test.toml --device 99"), 2, {"--device 99", "list devices"});
}

TEST_F(ErrorsTest, ListsAndDoctorWork) {
    for (const char* what :
         {"structures", "shadows", "scenes", "experiments", "devices", "metrics"}) {
        EXPECT_EQ(real(std::string("list ") + what).code, 0) << what;
        const Outcome listed = real(std::string("list --json ") + what);
        EXPECT_TRUE(nlohmann::json::accept(listed.out)) << what;
    }
    const Outcome doctor = real("doctor");
    EXPECT_EQ(doctor.code, 0) << doctor.err;
    EXPECT_NE(doctor.out.find("device 0"), std::string::npos);
}

}  // namespace
}  // namespace tests
