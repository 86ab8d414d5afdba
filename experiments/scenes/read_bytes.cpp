// Whole files into memory, through zlib where they are gzipped.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

/// Stops at more than any scene this program could hold: gzip data may unfold a thousandfold.
constexpr std::size_t kMaxBytes = std::size_t{16} << 30;

std::string read_plain(const std::filesystem::path& path) {
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (status.type() == std::filesystem::file_type::not_found) throw FormatError("no such file");
    if (std::filesystem::is_directory(status)) throw FormatError("is a folder, not a mesh file");

    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               &std::fclose);
    if (!file) throw FormatError(fmt::format("cannot be opened: {}", std::strerror(errno)));
    const auto size = std::filesystem::file_size(path, code);
    std::string bytes;
    if (!code) bytes.reserve(size + 1);
    // Reads until the end rather than `size` bytes: a pipe has no size, and a file may grow.
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    for (std::size_t got = kChunk; got == kChunk;) {
        const std::size_t start = bytes.size();
        bytes.resize(start + kChunk);
        got = std::fread(bytes.data() + start, 1, kChunk, file.get());
        bytes.resize(start + got);
        if (bytes.size() > kMaxBytes)
            throw FormatError(fmt::format("has more than {} GiB", kMaxBytes >> 30));
    }
    if (std::ferror(file.get()))
        throw FormatError(fmt::format("cannot be read: {}", std::strerror(errno)));
    return bytes;
}

/// Inflates every member of a gzip file.
std::string gunzip(std::string_view packed) {
    struct Stream : z_stream {
        Stream() : z_stream{} {
            constexpr int kGzipOnly = 16 + MAX_WBITS;
            if (inflateInit2(this, kGzipOnly) != Z_OK) throw std::bad_alloc();
        }
        ~Stream() { inflateEnd(this); }
        Stream(const Stream&) = delete;
        Stream& operator=(const Stream&) = delete;
    } stream;

    std::string bytes(std::max<std::size_t>(4 * packed.size(), 4096), '\0');
    std::size_t used = 0, written = 0;
    bool complete = false;  // whether the last member has ended
    while (used < packed.size() || !complete) {
        if (written == bytes.size()) bytes.resize(2 * bytes.size());
        constexpr std::size_t kStep = std::size_t{1} << 30;  // zlib counts in 32 bits
        const std::size_t in = std::min(packed.size() - used, kStep);
        const std::size_t out = std::min(bytes.size() - written, kStep);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
        stream.avail_in = static_cast<uInt>(in);
        stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + written);
        stream.avail_out = static_cast<uInt>(out);
        const int code = inflate(&stream, Z_NO_FLUSH);
        used += in - stream.avail_in;
        written += out - stream.avail_out;
        complete = code == Z_STREAM_END;
        if (complete) {
            inflateReset(&stream);
        } else if (code == Z_BUF_ERROR) {
            throw FormatError(
                fmt::format("gzip data ends early, after {} bytes ({} unpacked): the file is "
                            "truncated",
                            packed.size(), written));
        } else if (code == Z_MEM_ERROR) {
            throw std::bad_alloc();
        } else if (code != Z_OK) {
            throw FormatError(fmt::format("gzip data is corrupt at byte {}: {}", used,
                                          stream.msg ? stream.msg : "not in gzip format"));
        }
        if (written > kMaxBytes)
            throw FormatError(fmt::format("unpacks to more than {} GiB", kMaxBytes >> 30));
    }
    bytes.resize(written);
    return bytes;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path, bool gzipped) {
    std::string bytes = read_plain(path);
    if (bytes.empty()) throw FormatError("is empty");
    return gzipped ? gunzip(bytes) : bytes;
}

}  // namespace experiments::scenes
