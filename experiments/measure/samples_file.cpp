#include "experiments/measure/samples_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

#include "experiments/measure/metrics.hpp"

namespace experiments::measure {
namespace {

constexpr const char* kHeader = "scene,method,variant,frame,repetition,metric,value,unit\n";

std::vector<std::string> fields(std::string_view line) {
    std::vector<std::string> list(1);
    bool inside = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && inside && i + 1 < line.size() && line[i + 1] == '"')
            list.back() += line[++i];
        else if (c == '"')
            inside = !inside;
        else if (c == ',' && !inside)
            list.emplace_back();
        else
            list.back() += c;
    }
    return list;
}

template <typename T>
bool parse(const std::string& text, T& value) {
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    return result.ec == std::errc() && result.ptr == end;
}

struct Contents {
    std::vector<Row> rows;
    std::set<Key> complete;
    std::size_t bytes = 0;  ///< up to and with the last closing row
};

Contents read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw std::runtime_error(path.string() + ": cannot be opened");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    Contents contents;
    std::vector<Row> open;  // of the repetition not yet closed
    std::size_t begin = 0;
    for (int line = 1; begin < text.size(); ++line) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string::npos) break;  // torn
        const std::string_view row_text(text.data() + begin, end - begin);
        begin = end + 1;
        if (line == 1) {
            if (row_text != std::string_view(kHeader, std::strlen(kHeader) - 1))
                throw std::runtime_error(path.string() + ":1: is no samples file of grove");
            contents.bytes = begin;
            continue;
        }
        const auto f = fields(row_text);
        Row row;
        if (f.size() != 8 || !parse(f[3], row.key.frame) || !parse(f[4], row.key.repetition) ||
            !parse(f[6], row.sample.value))
            throw std::runtime_error(
                fmt::format("{}:{}: is no row of samples", path.string(), line));
        row.key.scene = f[0];
        row.key.method = f[1];
        row.key.variant = f[2];
        row.sample.metric = f[5];
        row.sample.unit = f[7];
        if (row.sample.metric == kComplete) {
            contents.complete.insert(row.key);
            contents.rows.insert(contents.rows.end(), open.begin(), open.end());
            open.clear();
            contents.bytes = begin;
        } else {
            open.push_back(std::move(row));
        }
    }
    return contents;
}

}  // namespace

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + '"';
}

std::vector<Row> read_samples(const std::filesystem::path& path) { return read(path).rows; }

SamplesFile::SamplesFile(std::filesystem::path path) : path_(std::move(path)) {
    std::size_t keep = 0;
    if (std::filesystem::exists(path_)) {
        Contents contents = read(path_);
        complete_ = std::move(contents.complete);
        keep = contents.bytes;
    }
    file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0 || ::ftruncate(file_, off_t(keep)) != 0)
        throw OutputError(fmt::format("{}: cannot be written: {}; choose another --out",
                                      path_.string(), std::strerror(errno)));
    if (keep == 0) write(kHeader);
}

SamplesFile::~SamplesFile() {
    if (file_ >= 0) ::close(file_);
}

void SamplesFile::append(const Key& key, const structures::Samples& samples) {
    const std::string prefix =
        fmt::format("{},{},{},{},{}", csv_field(key.scene), csv_field(key.method),
                    csv_field(key.variant), key.frame, key.repetition);
    std::string text;
    for (const structures::Sample& sample : samples)
        text += fmt::format("{},{},{},{}\n", prefix, csv_field(sample.metric), sample.value,
                            csv_field(sample.unit));
    write(text + fmt::format("{},{},1,1\n", prefix, kComplete));
    complete_.insert(key);
}

void SamplesFile::write(const std::string& text) {
    const auto fail = [&] {
        throw OutputError(
            fmt::format("{}: cannot be written: {}; make room, then go on with --resume --out {}",
                        path_.string(), std::strerror(errno), path_.parent_path().string()));
    };
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
        if (count < 0 && errno != EINTR) fail();
        if (count > 0) done += std::size_t(count);
    }
    // Devices and pipes cannot be synchronised (EINVAL); nothing is lost by that.
    if (::fsync(file_) != 0 && errno != EINVAL) fail();
}

}  // namespace experiments::measure
