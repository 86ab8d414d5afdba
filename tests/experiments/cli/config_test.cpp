// Configs: what is read, what is refused and where the message points, overrides, sweeps.
#include "experiments/config/config.hpp"

#include <gmock/gmock.h>

#include <unistd.h>

#include <fstream>
#include <random>

#include "tests/experiments/cli/fake_rows.hpp"

namespace tests {
namespace {

using namespace experiments::config;
using testing::HasSubstr;

const Catalogue& catalogue() {
    static const Catalogue made =
        make_catalogue(fake_registries().structures, fake_registries().methods);
    return made;
}

const std::string kText =
    "[experiment]\n"          // 1
    "name = \"t\"\n"          // 2
    "kind = \"shadows\"\n"    // 3
    "repeat = 7\n"            // 4
    "[[scene]]\n"             // 5
    "generator = \"city\"\n"  // 6
    "camera = { eye = [0, 4, 0], target = [1, 4, 0], fov_y_degrees = 50 }\n"
    "light = { type = \"directional\", direction = [0, -1, 0.5] }\n"
    "resolution = [320, 200]\n"  // 9
    "[[method]]\n"               // 10
    "name = \"stripes\"\n"       // 11
    "width = 16\n";              // 12

Config parse(const std::string& text, const std::vector<std::string>& sets = {}) {
    Node root = parse_text(text, "t.toml", "/base");
    for (const std::string& set : sets) override_value(root, set);
    return resolve(root, "/base/t.toml", catalogue());
}

/// The message that `text` with `sets` is refused with.
std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) {
    try {
        parse(text, sets);
    } catch (const ConfigError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(Config, ReadsWhatIsWritten) {
    const Config config = parse(kText);
    EXPECT_EQ(config.repeat, 7);
    EXPECT_EQ(config.warmup, 1);
    ASSERT_EQ(config.scenes.size(), 1u);
    EXPECT_EQ(config.scenes[0].name, "city");
    EXPECT_EQ(config.scenes[0].width, 320u);
    EXPECT_EQ(config.scenes[0].camera->fov_y_degrees, 50);
    EXPECT_EQ(config.scenes[0].camera->up, glm::vec3(0, 1, 0));
    EXPECT_EQ(config.scenes[0].light->vector, glm::vec3(0, -1, 0.5));
    ASSERT_EQ(config.methods.size(), 1u);
    EXPECT_EQ(config.methods[0].settings.integer("width"), 16);
    EXPECT_EQ(config.methods[0].variant, "width=16");
}

const std::string kPath =
    "path = { frames = 5, keys = [{ eye = [0, 4, 0], target = [1, 4, 0] }, { eye = [2, 4, 0], "
    "target = [3, 4, 0], fov_y_degrees = 60 }] }\n";

/// kText with `path` in place of its camera.
std::string with_path(const std::string& path) {
    std::string text = kText;
    const std::size_t begin = text.find("camera = "), end = text.find('\n', begin) + 1;
    return text.replace(begin, end - begin, path);
}

TEST(Config, ReadsPathsInPlaceAndFromFiles) {
    const Scene scene = parse(with_path(kPath)).scenes[0];
    ASSERT_TRUE(scene.path);
    EXPECT_EQ(scene.frames(), 5);
    EXPECT_FALSE(scene.all_pictures);
    ASSERT_EQ(scene.path->keys.size(), 2u);
    EXPECT_EQ(scene.path->keys[1].camera->eye, glm::vec3(2, 4, 0));
    EXPECT_EQ(scene.path->keys[0].camera->fov_y_degrees, 45);
    EXPECT_EQ(scene.path->keys[1].camera->fov_y_degrees, 60);
    EXPECT_FALSE(scene.path->keys[0].light);

    const auto file = std::filesystem::temp_directory_path() /
                      ("grove-walk-" + std::to_string(getpid()) + ".json");
    std::ofstream(file) << R"([{"eye": [0, 4, 0], "target": [1, 4, 0]},
        {"eye": [2, 4, 0], "target": [3, 4, 0], "fov_y_degrees": 60}])";
    const std::string from_file = "path = { frames = 5, keys = \"" + file.string() + "\" }\n";
    EXPECT_EQ(parse(with_path(from_file)).scenes[0].path, scene.path);
    // What decides the measurement is in the resolved config, wherever it was written.
    EXPECT_EQ(to_json(parse(with_path(from_file))), to_json(parse(with_path(kPath))));

    std::ofstream(file) << R"([{"eye": [0, 4, 0], "target": [1, 4, 0]}, {"eye": [0, 4, 0]}])";
    EXPECT_THAT(refusal(with_path(from_file)), HasSubstr(file.string() + ": key 2: "));
    std::ofstream(file) << R"({"eye": 1})";
    EXPECT_THAT(refusal(with_path(from_file)), HasSubstr(file.string() + ": is no list of keys"));
    std::ofstream(file) << "[{";
    EXPECT_THAT(refusal(with_path(from_file)), HasSubstr(file.string() + ": is no JSON"));
    std::filesystem::remove(file);
    EXPECT_THAT(refusal(with_path(from_file)), HasSubstr("t.toml:7: '" + file.string()));
}

TEST(Config, RefusesPathsThatCannotBeFollowed) {
    EXPECT_THAT(refusal(with_path("path = { frames = 5 }\n")), HasSubstr("lacks the key 'keys'"));
    EXPECT_THAT(refusal(with_path("path = { keys = [] }\n")), HasSubstr("lacks the key 'frames'"));
    EXPECT_THAT(refusal(with_path(replaced(kPath, "5", "0"))), HasSubstr("'frames' is 0"));
    EXPECT_THAT(refusal(with_path("path = { frames = 5, keys = [] }\n")), HasSubstr("no keys"));
    EXPECT_THAT(refusal(with_path(replaced(kPath, "fov_y_degrees", "fov"))),
                HasSubstr("t.toml:7: unknown key 'fov'"));
    EXPECT_THAT(refusal(with_path(replaced(kPath, "eye = [2, 4, 0], ", ""))),
                HasSubstr("lacks the key 'eye'"));
    EXPECT_THAT(refusal(replaced(kText, "resolution", kPath + "resolution")),
                HasSubstr("t.toml:9: 'path' excludes 'camera'"));
    EXPECT_THAT(refusal(replaced(with_path(kPath), "shadows", "build")),
                HasSubstr("'path' is a key of kind 'shadows' alone"));
}

TEST(Config, UnknownKeysNameLineAndSuggestion) {
    EXPECT_THAT(refusal(replaced(kText, "repeat", "repaet")),
                HasSubstr("t.toml:4: unknown key 'repaet'; did you mean 'repeat'?"));
    EXPECT_THAT(refusal(replaced(kText, "resolution", "resolutoin")), HasSubstr("t.toml:9: "));
    EXPECT_THAT(refusal(replaced(kText, "width", "widht")),
                HasSubstr("t.toml:12: unknown key 'widht'; did you mean 'width'?"));
    EXPECT_THAT(refusal(replaced(kText, "eye", "eyes")), HasSubstr("t.toml:7: "));
    EXPECT_THAT(refusal(replaced(kText, "[[method]]", "[[methods]]")), HasSubstr("[[method]]"));
    EXPECT_THAT(refusal("[extra]\n" + kText), HasSubstr("t.toml:1: unknown key 'extra'"));
}

TEST(Config, KeysOfShadowsAreUnknownToBuilds) {
    const std::string build =
        "[experiment]\nkind = \"build\"\n[[scene]]\ngenerator = \"city\"\n"
        "[[method]]\nname = \"fake_tree\"\n";
    EXPECT_EQ(refusal(build), "accepted");
    for (const std::string key : {"truth=true", "pictures=false", "reference=fake_tree"}) {
        EXPECT_THAT(refusal(build, {"experiment." + key}),
                    HasSubstr("unknown key '" + key.substr(0, key.find('=')) + "'"));
    }
}

TEST(Config, WrongTypesNameWhatWasExpected) {
    const std::pair<const char*, const char*> cases[][2] = {
        {{"repeat = 7", "repeat = 7.5"}, {"t.toml:4: ", "expected an integer"}},
        {{"repeat = 7", "repeat = 0"}, {"t.toml:4: ", "expected an integer from 1"}},
        {{"repeat = 7", "repeat = [1, 2]"}, {"t.toml:4: ", "is a list"}},
        {{"repeat = 7", "repeat = 2020-01-01"}, {"t.toml:4: ", "dates"}},
        {{"\"t\"", "7"}, {"t.toml:2: ", "expected a string"}},
        {{"\"t\"", "\"../t\""}, {"t.toml:2: ", "folder"}},
        {{"[320, 200]", "[320]"}, {"t.toml:9: ", "[width, height]"}},
        {{"[320, 200]", "[320, -1]"}, {"t.toml:9: ", "integers from 1"}},
        {{"[0, 4, 0]", "[0, 4]"}, {"t.toml:7: ", "[x, y, z]"}},
        {{"[0, 4, 0]", "[0, nan, 0]"}, {"t.toml:7: ", "finite"}},
        {{"[0, 4, 0]", "[1, 4, 0]"}, {"t.toml:7: ", "same point"}},
        {{"50", "180"}, {"t.toml:7: ", "fov_y_degrees"}},
        {{"[0, -1, 0.5]", "[0, 0, 0]"}, {"t.toml:8: ", "must not be zero"}},
        {{"directional", "point"}, {"t.toml:8: ", "position"}},
        {{"width = 16", "width = \"a\""}, {"t.toml:12: ", "expected an integer"}},
        {{"width = 16", "width = 1000"}, {"t.toml:12: ", "from 1 to 64"}},
        {{"width = 16", "width = []"}, {"t.toml:12: ", "empty list"}},
        {{"width = 16", "width = {a = 1}"}, {"t.toml:12: ", "a table"}},
    };
    for (const auto& [change, expected] : cases) {
        const std::string message = refusal(replaced(kText, change.first, change.second));
        EXPECT_THAT(message, HasSubstr(expected.first)) << change.second;
        EXPECT_THAT(message, HasSubstr(expected.second)) << change.second;
    }
}

TEST(Config, OverridesReachEveryPlace) {
    const Config config =
        parse(kText, {"experiment.repeat=2", "scene.0.resolution=[8, 9]",
                      "scene.0.camera.eye=[1,2,3]", "method.0.variant=bare word",
                      "method.1.name=rival", "method.1.width=3", "experiment.reference=rival"});
    EXPECT_EQ(config.repeat, 2);
    EXPECT_EQ(config.scenes[0].height, 9u);
    EXPECT_EQ(config.scenes[0].camera->eye, glm::vec3(1, 2, 3));
    EXPECT_EQ(config.methods[0].variant, "bare word");
    ASSERT_EQ(config.methods.size(), 2u);
    EXPECT_EQ(config.methods[1].settings.integer("width"), 3);
    EXPECT_EQ(config.reference, 1u);
}

TEST(Config, OverridesAreRefusedByName) {
    EXPECT_THAT(refusal(kText, {"experiment.repat=2"}),
                HasSubstr("--set experiment.repat: unknown"));
    EXPECT_THAT(refusal(kText, {"method.7.name=rival"}), HasSubstr("--set method.7.name"));
    EXPECT_THAT(refusal(kText, {"method.x=1"}), HasSubstr("index"));
    EXPECT_THAT(refusal(kText, {"repeat"}), HasSubstr("KEY=VALUE"));
    EXPECT_THAT(refusal(kText, {"a..b=1"}), HasSubstr("empty"));
    EXPECT_THAT(refusal(kText, {"experiment.repeat=2\nx=1"}), HasSubstr("expected an integer"));
}

TEST(Config, PathsStartAtTheirOrigin) {
    const std::string text = replaced(kText, "generator = \"city\"", "file = \"none.ply\"");
    EXPECT_THAT(refusal(text), HasSubstr("'/base/none.ply' does not exist"));
    EXPECT_THAT(refusal(text, {"scene.0.file=other.ply"}),
                HasSubstr((std::filesystem::current_path() / "other.ply").string()));
}

TEST(Config, ListsAreSweeps) {
    const Config config = parse(kText, {"method.0.width=[8, 16, 32]", "method.0.scale=[1.0, 0.5]",
                                        "scene.0.resolution=[[8, 8], [16, 8]]"});
    EXPECT_EQ(config.methods.size(), 6u);
    EXPECT_EQ(config.methods[0].variant, "width=8,scale=1");
    EXPECT_EQ(config.methods[5].variant, "width=32,scale=0.5");
    ASSERT_EQ(config.scenes.size(), 2u);
    EXPECT_EQ(config.scenes[1].name, "city,resolution=16x8");
    EXPECT_EQ(config.scenes[1].width, 16u);
    // A method's own key may sweep though a scene's key of that name takes a list.
    EXPECT_EQ(parse(kText, {"method.0.resolution=[8, 16]"}).methods.size(), 2u);
}

TEST(Config, SameMethodTwiceNeedsVariants) {
    const std::string twice = kText + "[[method]]\nname = \"stripes\"\nwidth = 16\n";
    EXPECT_THAT(refusal(twice), HasSubstr("'variant'"));
    EXPECT_EQ(refusal(twice + "variant = \"again\"\n"), "accepted");
}

TEST(Config, LabelsAreOneLine) {
    EXPECT_THAT(refusal(kText + "variant = \"a\\nb\"\n"), HasSubstr("control character"));
    EXPECT_THAT(refusal(kText + "variant = \"\"\n"), HasSubstr("is empty"));
}

TEST(Config, SeedReachesTheGenerator) {
    EXPECT_EQ(parse(kText, {"experiment.seed=9"}).scenes[0].settings.integer("seed"), 9);
    EXPECT_EQ(
        parse(kText, {"experiment.seed=9", "scene.0.seed=4"}).scenes[0].settings.integer("seed"),
        4);
}

TEST(Config, EqualExperimentsGiveEqualText) {
    EXPECT_EQ(to_json(parse(kText)), to_json(parse("# comment\n" + kText)));
    EXPECT_NE(to_json(parse(kText)), to_json(parse(kText, {"experiment.seed=2"})));
}

/// Whatever the text, it is read or refused by ConfigError: no crash, no other exception.
TEST(Config, DamagedTextIsRefusedNotFatal) {
    const unsigned seed = 20261123;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::string alphabet = "[]{}=.,\"'\\#\n\r\t -+_0x9ez\xff\x01\xc3";
    for (int round = 0; round < 20000; ++round) {
        std::string text = kText;
        for (int edits = 1 + int(random() % 4); edits > 0; --edits) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
                case 0:
                    text[at] = alphabet[random() % alphabet.size()];
                    break;
                case 1:
                    text.insert(at, 1, alphabet[random() % alphabet.size()]);
                    break;
                default:
                    text.erase(at, 1 + random() % 8);
            }
        }
        try {
            parse(text);
        } catch (const ConfigError&) {
        }
    }
}

}  // namespace
}  // namespace tests
