// samples.csv: one row per measured number, written as it is measured.
//
//     SamplesFile file(folder / "samples.csv");
//     if (!file.complete({"city", "bvh", "default", 0, 2}))
//         file.append({"city", "bvh", "default", 0, 2}, {{"build_ms", 3.2, "ms"}});
//
// The rows of one repetition go to disk together, closed by a row with metric `complete`. What
// follows the last such row is the torn end of a killed run; opening the file cuts it off.
#pragma once

#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "structures/sample.hpp"

namespace experiments::measure {

/// Results cannot be written (full disk, removed folder): exit code 1, and no further work.
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// `text` as a field of a CSV line, quoted as in RFC 4180 if it must be: labels hold commas.
std::string csv_field(const std::string& text);

struct Key {
    std::string scene, method, variant;
    int frame = 0;
    int repetition = 0;
    bool operator==(const Key&) const = default;
    bool operator<(const Key& other) const {
        return std::tie(scene, method, variant, frame, repetition) <
               std::tie(other.scene, other.method, other.variant, other.frame, other.repetition);
    }
};

struct Row {
    Key key;
    structures::Sample sample;
};

/// All complete repetitions' rows, the closing ones left out. Throws std::runtime_error naming the
/// file and line if it is no samples file.
std::vector<Row> read_samples(const std::filesystem::path& path);

class SamplesFile {
  public:
    /// Opens or creates. Throws OutputError, or std::runtime_error as read_samples().
    explicit SamplesFile(std::filesystem::path path);
    ~SamplesFile();
    SamplesFile(const SamplesFile&) = delete;
    SamplesFile& operator=(const SamplesFile&) = delete;

    bool complete(const Key& key) const { return complete_.contains(key); }
    /// Writes the rows and waits until they are on disk. Throws OutputError.
    void append(const Key& key, const structures::Samples& samples);

  private:
    void write(const std::string& text);

    std::filesystem::path path_;
    std::set<Key> complete_;
    int file_ = -1;
};

}  // namespace experiments::measure
