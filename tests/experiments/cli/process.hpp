// Runs programs as a user does, and folders to run them in.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tests {

struct Outcome {
    int code = -1;    ///< exit code; 128 + signal if killed
    std::string out;  ///< standard output
    std::string err;  ///< standard error
};

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

/// A fresh folder per test, removed afterwards, and the two programs run in it.
class CliTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    /// The program with the fake structure and methods. `before` is shell text put in front
    /// ("VAR=value", "ulimit -f 1;").
    Outcome fake(const std::string& arguments, const std::string& before = {});
    /// The program as it is delivered.
    Outcome real(const std::string& arguments, const std::string& before = {});
    Outcome shell(const std::string& command);

    /// A config of two fake methods on a small generated scene, with `extra` appended.
    std::filesystem::path write_config(const std::string& extra = {},
                                       const std::string& experiment = {});
    nlohmann::json json(const std::filesystem::path& file);

    std::filesystem::path folder_;
};

/// Exit code as expected, and exactly one line of error that holds all of `parts`.
void expect_error(const Outcome& outcome, int code, const std::vector<std::string>& parts);

}  // namespace tests
