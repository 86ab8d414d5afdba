// PLY reader: ASCII and binary of both byte orders, any scalar types, any extra properties and
// elements.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "experiments/scenes/ply_header.hpp"
#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using namespace ply;

/// Reads the values of a binary body one after the other.
template <bool kSwapped>
class BinaryBody {
  public:
    explicit BinaryBody(std::string_view bytes) : bytes_(bytes) {}
    static constexpr std::size_t min_size(Type type) { return kSizes[static_cast<int>(type)]; }
    static constexpr std::size_t kSpare = 0;
    std::size_t left() const { return bytes_.size() - at_; }
    std::size_t at() const { return at_; }

    /// False at the end of the data.
    bool read(Type type, double& value) {
        switch (type) {
            case Type::i8:
                return read_as<std::int8_t>(value);
            case Type::u8:
                return read_as<std::uint8_t>(value);
            case Type::i16:
                return read_as<std::int16_t>(value);
            case Type::u16:
                return read_as<std::uint16_t>(value);
            case Type::i32:
                return read_as<std::int32_t>(value);
            case Type::u32:
                return read_as<std::uint32_t>(value);
            case Type::f32:
                return read_as<float>(value);
            case Type::f64:
                return read_as<double>(value);
        }
        return false;
    }

  private:
    template <typename T>
    bool read_as(double& value) {
        if (left() < sizeof(T)) return false;
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
        if constexpr (kSwapped) std::reverse(raw.begin(), raw.end());
        value = static_cast<double>(std::bit_cast<T>(raw));
        at_ += sizeof(T);
        return true;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
};

/// Reads the values of an ASCII body; any white space separates them. Reals are rounded once, to a
/// float; integers need a double's digits.
class AsciiBody {
  public:
    explicit AsciiBody(std::string_view bytes) : bytes_(bytes) {}
    // A digit and a blank, but for the last number.
    static constexpr std::size_t min_size(Type) { return 2; }
    static constexpr std::size_t kSpare = 1;
    std::size_t left() const { return bytes_.size() - at_; }
    std::size_t at() const { return at_; }

    bool read(Type type, double& value) {
        at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
        if (at_ == bytes_.size()) return false;
        const char* const begin = bytes_.data() + at_;
        const char* const end = bytes_.data() + bytes_.size();
        const char* stop = nullptr;
        if (type == Type::f32 || type == Type::f64) {
            float single = 0;
            stop = parse_float(begin, end, single);
            value = single;
        } else if (const auto result = std::from_chars(begin, end, value);
                   result.ec == std::errc()) {
            stop = result.ptr;
        }
        if (!stop || (stop != end && !std::strchr(" \t\r\n", *stop)))
            throw FormatError(fmt::format("byte {} of the PLY body is no number", at_));
        at_ = static_cast<std::size_t>(stop - bytes_.data());
        return true;
    }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

template <typename Body>
class Reader {
  public:
    Reader(const Header& header, Body body, LoadedMesh& scene)
        : header_(header), body_(body), scene_(scene) {}

    void read() {
        for (const Element& element : header_.elements) {
            check_count(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip(element);
        }
    }

  private:
    /// How many things of at least `size` bytes may still come.
    std::size_t room(std::size_t size) const { return (body_.left() + Body::kSpare) / size; }

    /// Holds an element's count against the bytes that are there, before anything is allocated.
    void check_count(const Element& element) const {
        std::size_t size = 0;
        for (const Property& p : element.properties)
            size += Body::min_size(p.count_type.value_or(p.type));
        if (size == 0 || element.count <= room(size)) return;
        throw FormatError(
            fmt::format("announces {} {} elements of at least {} bytes each, but only {} bytes are "
                        "left, enough "
                        "for {}: truncated, or a wrong count",
                        element.count, element.name, size, body_.left(), room(size)));
    }

    double next(Type type, const Element& element, std::size_t index) {
        double value = 0;
        if (!body_.read(type, value))
            throw FormatError(
                fmt::format("ends inside {} {} of {}, {} bytes into the body: truncated",
                            element.name, index, element.count, body_.at()));
        return value;
    }

    /// The values of one property of one element: one, or a list's.
    void next_values(const Property& property, const Element& element, std::size_t index) {
        values_.clear();
        double count = 1;
        if (property.count_type) {
            count = next(*property.count_type, element, index);
            if (!(count >= 0) || count != std::floor(count) ||
                count > static_cast<double>(room(Body::min_size(property.type))))
                throw FormatError(
                    fmt::format("{} {} has a list of {} values, with {} bytes left: "
                                "truncated or corrupt",
                                element.name, index, count, body_.left()));
        }
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            values_.push_back(next(property.type, element, index));
    }

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) next_values(property, element, i);
        scene_.report.skipped += element.count;
    }

    void read_vertices(const Element& element) {
        std::array<std::size_t, 3> axis_property{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto is_axis = [&](const Property& p) {
                return p.name == std::string(1, "xyz"[axis]) && !p.count_type;
            };
            const auto it =
                std::find_if(element.properties.begin(), element.properties.end(), is_axis);
            if (it == element.properties.end())
                throw FormatError(fmt::format("PLY vertices have no property '{}'", "xyz"[axis]));
            axis_property[axis] = static_cast<std::size_t>(it - element.properties.begin());
        }
        auto& positions = scene_.mesh.positions;
        positions.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i) {
            glm::vec3 position(0);
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                next_values(element.properties[p], element, i);
                for (int axis = 0; axis < 3; ++axis)
                    if (axis_property[axis] == p) position[axis] = static_cast<float>(values_[0]);
            }
            positions.push_back(position);
        }
    }

    void read_faces(const Element& element) {
        const auto is_corners = [](const Property& p) {
            return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
        };
        if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
            throw FormatError("PLY faces have no list 'vertex_indices' or 'vertex_index'");
        const std::size_t vertex_count = scene_.mesh.positions.size();
        scene_.mesh.triangles.reserve(element.count);
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                next_values(property, element, i);
                if (!is_corners(property)) continue;
                corners_.clear();
                for (const double value : values_) {
                    if (!(value >= 0 && value < static_cast<double>(vertex_count)))
                        throw FormatError(
                            fmt::format("face {} refers to vertex {}, but {} vertices precede it "
                                        "(counted from 0)",
                                        i, value, vertex_count));
                    corners_.push_back(static_cast<std::uint32_t>(value));
                }
                add_polygon(corners_, scene_);
            }
    }

    const Header& header_;
    Body body_;
    LoadedMesh& scene_;
    std::vector<double> values_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

void read_ply(std::string_view bytes, LoadedMesh& scene) {
    const Header header = parse_header(bytes);
    const std::string_view body = bytes.substr(header.size);
    constexpr bool kBigHost = std::endian::native == std::endian::big;
    if (header.format == "ascii")
        Reader(header, AsciiBody(body), scene).read();
    else if (header.format == "binary_little_endian")
        Reader(header, BinaryBody<kBigHost>(body), scene).read();
    else if (header.format == "binary_big_endian")
        Reader(header, BinaryBody<!kBigHost>(body), scene).read();
    else
        throw FormatError(
            fmt::format("PLY format '{}' is none of ascii, binary_little_endian, "
                        "binary_big_endian",
                        header.format));
}

}  // namespace experiments::scenes
