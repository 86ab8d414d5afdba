// OpenEXR files. They are encoded in memory, so that every way of failing to write is in
// write_file.
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>

#include <cstring>
#include <set>

#include "experiments/image/image.hpp"

namespace experiments::image {
namespace {

class MemoryStream : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char* data, int size) override {
        const std::size_t end = at_ + static_cast<std::size_t>(size);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, data, static_cast<std::size_t>(size));
        at_ = end;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    std::span<const char> bytes() const { return bytes_; }

  private:
    std::vector<char> bytes_;
    std::size_t at_ = 0;
};

/// One slice per channel of an interleaved image whose pixel (x0, y0) is its first.
void add_slices(Imf::FrameBuffer& buffer, std::span<const std::string> names, Image& image, int x0,
                int y0) {
    const std::size_t x_stride = sizeof(float) * image.channels;
    const std::size_t y_stride = x_stride * image.width;
    for (std::size_t c = 0; c < names.size(); ++c) {
        // OpenEXR addresses pixel (x, y) as base + x * x_stride + y * y_stride.
        char* const base = reinterpret_cast<char*>(image.values.data() + c) -
                           std::ptrdiff_t(x0) * std::ptrdiff_t(x_stride) -
                           std::ptrdiff_t(y0) * std::ptrdiff_t(y_stride);
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, x_stride, y_stride));
    }
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image,
               std::span<const std::string> channel_names) {
    if (image.width <= 0 || image.height <= 0 || image.channels <= 0)
        throw std::invalid_argument("write_exr: the image is empty");
    const std::set<std::string> distinct(channel_names.begin(), channel_names.end());
    if (distinct.size() != static_cast<std::size_t>(image.channels) ||
        channel_names.size() != distinct.size() || distinct.contains(""))
        throw std::invalid_argument(
            fmt::format("write_exr: {} channels need as many distinct names, got {}",
                        image.channels, channel_names.size()));
    MemoryStream stream;
    try {
        Imf::Header header(image.width, image.height);
        for (const std::string& name : channel_names)
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        Imf::FrameBuffer buffer;
        add_slices(buffer, channel_names, const_cast<Image&>(image), 0, 0);  // only read from
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    } catch (const std::exception& error) {
        throw FileError(path, fmt::format("cannot be encoded as OpenEXR: {}", error.what()));
    }
    write_file(path, stream.bytes());
}

NamedImage read_exr(const std::filesystem::path& path) {
    try {
        Imf::InputFile file(path.c_str());
        const Imath::Box2i window = file.header().dataWindow();
        NamedImage result;
        for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it)
            result.channel_names.emplace_back(it.name());
        constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
        const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
        if (width < 1 || height < 1 || width > kMaxPixels / height)
            throw std::runtime_error(fmt::format("{} x {} pixels", width, height));
        result.image = Image(static_cast<int>(width), static_cast<int>(height),
                             static_cast<int>(result.channel_names.size()));
        Imf::FrameBuffer buffer;
        add_slices(buffer, result.channel_names, result.image, window.min.x, window.min.y);
        file.setFrameBuffer(buffer);
        file.readPixels(window.min.y, window.max.y);
        return result;
    } catch (const std::exception& error) {
        throw FileError(path, fmt::format("cannot be read as OpenEXR: {}", error.what()));
    }
}

}  // namespace experiments::image
