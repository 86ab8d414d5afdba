#include "tests/experiments/cli/process.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace tests {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_text(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

void CliTest::SetUp() {
    std::string pattern = (fs::temp_directory_path() / "grove-cli-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
}

void CliTest::TearDown() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

Outcome CliTest::shell(const std::string& command) {
    const fs::path out = folder_ / "stdout.txt", err = folder_ / "stderr.txt";
    // Nothing is taken from, or left in, the user's own cache.
    const std::string line = "cd '" + folder_.string() + "' && export GROVE_CACHE='" +
                             (folder_ / "cache").string() + "' && { " + command + "\n} >'" +
                             out.string() + "' 2>'" + err.string() + "' </dev/null";
    const int status = std::system(line.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                    read_text(out), read_text(err)};
    return outcome;
}

Outcome CliTest::fake(const std::string& arguments, const std::string& before) {
    return shell(before + " '" GROVE_FAKE "' " + arguments);
}

Outcome CliTest::real(const std::string& arguments, const std::string& before) {
    return shell(before + " '" GROVE_REAL "' " + arguments);
}

fs::path CliTest::write_config(const std::string& extra, const std::string& experiment) {
    const fs::path file = folder_ / "test.toml";
    write_text(file,
               "[experiment]\n"
               "name = \"small\"\n"
               "kind = \"shadows\"\n"
               "repeat = 3\n" +
                   experiment +
                   "[[scene]]\n"
                   "generator = \"spheres\"\n"
                   "n = 4\ntessellation = 4\n"
                   "resolution = [64, 48]\n"
                   "[[method]]\n"
                   "name = \"stripes\"\n" +
                   extra);
    return file;
}

nlohmann::json CliTest::json(const fs::path& file) {
    return nlohmann::json::parse(read_text(folder_ / file));
}

void expect_error(const Outcome& outcome, int code, const std::vector<std::string>& parts) {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    std::vector<std::string> errors;
    std::size_t begin = 0;
    while (begin < outcome.err.size()) {
        const std::size_t end = std::min(outcome.err.find('\n', begin), outcome.err.size());
        const std::string line = outcome.err.substr(begin, end - begin);
        if (line.starts_with("grove: error: ")) errors.push_back(line);
        begin = end + 1;
    }
    ASSERT_EQ(errors.size(), 1u) << outcome.err;
    for (const std::string& part : parts)
        EXPECT_NE(errors[0].find(part), std::string::npos)
            << "no '" << part << "' in: " << errors[0];
}

}  // namespace tests
