#include "experiments/measure/truth_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <type_traits>

#include "experiments/image/image.hpp"
#include "experiments/measure/digest.hpp"

namespace experiments::measure {
namespace {

namespace fs = std::filesystem;
using shadows::truth::Effort;
using shadows::truth::Verdict;
using shadows::truth::Verdicts;

/// Of the file's layout.
constexpr int kLayout = 1;

// A file holds the checksum of its body in hexadecimal digits, then the body: the key, the effort,
// one byte per point.
constexpr std::size_t kDigits = 64;
static_assert(std::is_trivially_copyable_v<Effort>);
static_assert(std::is_trivially_copyable_v<Verdict> && sizeof(Verdict) == 1);

template <typename T>
std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string body_of(const std::string& key, const Verdicts& verdicts) {
    std::string body = key;
    body.append(reinterpret_cast<const char*>(&verdicts.effort), sizeof(Effort));
    return body.append(bytes_of(verdicts.points));
}

/// Why `text` is no entry of `key` with `count` points, or nothing.
std::string damage(std::string_view text, const std::string& key, std::size_t count) {
    const std::size_t expected = 2 * kDigits + sizeof(Effort) + count;
    if (text.size() != expected)
        return fmt::format("it has {} bytes, expected {}", text.size(), expected);
    if (text.substr(0, kDigits) != sha256(text.substr(kDigits)) ||
        text.substr(kDigits, kDigits) != key)
        return "its checksum is wrong";
    return {};
}

}  // namespace

std::string truth_key(const structures::geometry::TriangleMesh& mesh,
                      const structures::geometry::Light& light,
                      const shadows::PointArrays& points) {
    std::string parts =
        fmt::format("truth {} {} {} {:a} {:a} {:a}", kLayout, shadows::truth::kVersion,
                    int(light.type), light.vector.x, light.vector.y, light.vector.z);
    for (const std::string_view part : {bytes_of(mesh.positions), bytes_of(mesh.triangles),
                                        bytes_of(points.x), bytes_of(points.y), bytes_of(points.z),
                                        bytes_of(points.primitive), bytes_of(points.normal)})
        parts += sha256(part);
    return sha256(parts);
}

fs::path default_cache_folder() {
    // The XDG base directory specification wants relative paths ignored.
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && fs::path(cache).is_absolute()) return fs::path(cache) / "grove";
    const char* home = std::getenv("HOME");
    if (home && fs::path(home).is_absolute()) return fs::path(home) / ".cache/grove";
    return {};
}

TruthCache::TruthCache(const fs::path& folder, Warn warn)
    : folder_(folder.empty() ? folder : folder / "truth"), warn_(std::move(warn)) {}

std::optional<Verdicts> TruthCache::load(const std::string& key, std::size_t count) const {
    const fs::path file = entry(key);
    std::error_code code;
    if (folder_.empty() || !fs::exists(file, code)) return {};
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::string why = stream.is_open()
                                ? damage(text, key, count)
                                : "it cannot be read: " + std::string(std::strerror(errno));
    if (!why.empty()) {
        warn_(fmt::format("truth cache: {}: {}; the points are judged again", file.string(), why));
        return {};
    }
    Verdicts verdicts;
    std::memcpy(&verdicts.effort, text.data() + 2 * kDigits, sizeof(Effort));
    verdicts.points.resize(count);
    std::memcpy(verdicts.points.data(), text.data() + text.size() - count, count);
    return verdicts;
}

void TruthCache::store(const std::string& key, const Verdicts& verdicts) {
    if (folder_.empty() || !writable_) return;
    const std::string body = body_of(key, verdicts);
    const fs::path file = entry(key), part = fmt::format("{}.{}", file.string(), ::getpid());
    std::string why;
    try {
        fs::create_directories(folder_);
        image::write_file(part, sha256(body) + body);
        fs::rename(part, file);
        return;
    } catch (const std::exception& error) {
        why = error.what();
    }
    writable_ = false;
    warn_(fmt::format("truth cache: {}; the truth is not kept, choose another folder with --cache",
                      why));
}

}  // namespace experiments::measure
