// Rules about the source tree itself, read off the files: who includes whom, what libraries may not
// do, how long files are, and that adding a structure touches one line outside its folder.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = GROVE_SOURCE_DIR;

/// Layers and what each may include besides itself.
const std::map<std::string, std::vector<std::string>> kLayers{
    {"taskpool", {}},
    {"structures", {"taskpool"}},
    {"shadows", {"taskpool", "structures"}},
    {"raytrace", {"taskpool", "structures"}},
    {"experiments", {"taskpool", "structures", "shadows", "raytrace"}},
    {"tests", {"taskpool", "structures", "shadows", "raytrace", "experiments"}},
};
const std::vector<std::string> kLibraries{"taskpool", "structures", "shadows", "raytrace"};

struct SourceFile {
    std::string path;  ///< from the root
    std::vector<std::string> lines;
};

bool is_source(const fs::path& path) {
    static const std::vector<std::string> kinds{".hpp",  ".cpp",  ".h",    ".glsl",
                                                ".comp", ".vert", ".frag", ".cmake"};
    return std::find(kinds.begin(), kinds.end(), path.extension()) != kinds.end() ||
           path.filename() == "CMakeLists.txt";
}

std::vector<SourceFile> sources_below(const std::string& folder) {
    std::vector<SourceFile> files;
    if (!fs::exists(kRoot / folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
        if (!entry.is_regular_file() || !is_source(entry.path())) continue;
        SourceFile file{fs::relative(entry.path(), kRoot).generic_string(), {}};
        std::ifstream stream(entry.path());
        for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
        files.push_back(std::move(file));
    }
    std::sort(files.begin(), files.end(),
              [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    return files;
}

/// "path:line: text" of the lines that match outside a `//` comment.
std::vector<std::string> matches(const SourceFile& file, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
        if (std::regex_search(file.lines[i].substr(0, file.lines[i].find("//")), pattern))
            found.push_back(file.path + ":" + std::to_string(i + 1) + ": " + file.lines[i]);
    return found;
}

TEST(Layering, IncludesPointLeft) {
    const std::regex include("^\\s*#include \"([^\"/]+)/?[^\"]*\"");
    std::size_t seen = 0;
    for (const auto& [layer, allowed] : kLayers)
        for (const SourceFile& file : sources_below(layer))
            for (const std::string& line : file.lines) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                ++seen;
                const std::string target = match[1];
                EXPECT_TRUE(target == layer ||
                            std::find(allowed.begin(), allowed.end(), target) != allowed.end())
                    << file.path << ": " << line
                    << "\nincludes are written from the root and point to " << layer
                    << " or a layer on its left";
            }
    EXPECT_GT(seen, 100u);
}

// The folders of the program build on one another, too.
TEST(Layering, FoldersOfTheProgramFormNoCircle) {
    const std::regex include("^\\s*#include \"experiments/([^\"/]+)/");
    std::map<std::string, std::set<std::string>> needed;
    for (const SourceFile& file : sources_below("experiments")) {
        const std::string folder = file.path.substr(std::string("experiments/").size());
        const std::size_t slash = folder.find('/');
        if (slash == std::string::npos) continue;  // main.cpp
        auto& others = needed[folder.substr(0, slash)];
        for (const std::string& line : file.lines)
            if (std::smatch match; std::regex_search(line, match, include)) others.insert(match[1]);
        others.erase(folder.substr(0, slash));
    }
    // Whoever needs nobody that is left goes, until nobody can.
    for (bool going = true; going;) {
        going = std::erase_if(needed, [](const auto& one) { return one.second.empty(); }) > 0;
        for (auto& [folder, others] : needed)
            std::erase_if(others, [&](const std::string& o) { return !needed.contains(o); });
    }
    EXPECT_THAT(needed, testing::IsEmpty()) << "these folders need one another";
}

TEST(Layering, LibrariesNeitherPrintNorOpenFilesNorReadTheEnvironment) {
    // snprintf and sscanf work on strings.
    const std::regex forbidden(
        "\\b(fopen|freopen|[io]?fstream|getenv|setenv|printf|fprintf|puts|fputs|perror)\\b|"
        "std::(cout|cerr|clog)|fmt::print|#include <(iostream|fstream|filesystem)>");
    for (const std::string& layer : kLibraries)
        for (const SourceFile& file : sources_below(layer)) {
            if (file.path.ends_with(".cmake") || file.path.ends_with(".txt")) continue;
            EXPECT_THAT(matches(file, forbidden), testing::IsEmpty());
        }
}

TEST(SourceTree, FilesAreShortAndSayWhatTheyAre) {
    for (const auto& [layer, allowed] : kLayers)
        for (const SourceFile& file : sources_below(layer)) {
            EXPECT_LE(file.lines.size(), 500u) << file.path << " is too long";
            if (file.path.ends_with(".cmake") || file.path.ends_with("CMakeLists.txt")) continue;
            ASSERT_FALSE(file.lines.empty()) << file.path;
            // A source file beside its header may leave it to that.
            const bool has_header = file.path.ends_with(".cpp") &&
                                    fs::exists((kRoot / file.path).replace_extension(".hpp"));
            EXPECT_TRUE(has_header || file.lines[0].starts_with("//"))
                << file.path << " does not begin with a comment that says what it is";
        }
}

TEST(SourceTree, EveryTopFolderHasAReadme) {
    for (const auto& [layer, allowed] : kLayers)
        if (fs::exists(kRoot / layer))
            EXPECT_TRUE(fs::exists(kRoot / layer / "README.md")) << layer;
}

// The ball tree is kept to show that a structure needs nothing outside its folder but its line.
TEST(SourceTree, TheBallTreeIsRegisteredByOneLine) {
    std::vector<std::string> mentions;
    for (const auto& [layer, allowed] : kLayers) {
        if (layer == "tests") continue;
        for (const SourceFile& file : sources_below(layer)) {
            if (file.path.starts_with("structures/ball_tree/")) continue;
            const auto found = matches(file, std::regex("ball_tree"));
            mentions.insert(mentions.end(), found.begin(), found.end());
        }
    }
    EXPECT_THAT(mentions, testing::ElementsAre(testing::MatchesRegex(
                              "structures/CMakeLists.txt:[0-9]+: add_structure\\(ball_tree\\)")));
}

}  // namespace
