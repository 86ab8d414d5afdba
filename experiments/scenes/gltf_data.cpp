// glTF containers, buffers and accessors.
#include "experiments/scenes/gltf_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using nlohmann::json;

// Component types, as glTF numbers them (those of OpenGL).
enum Component { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

std::size_t component_size(int type) {
    switch (type) {
        case kByte:
        case kUnsignedByte:
            return 1;
        case kShort:
        case kUnsignedShort:
            return 2;
        case kUnsignedInt:
        case kFloat:
            return 4;
        default:
            throw FormatError(fmt::format("glTF component type {} is unknown", type));
    }
}

template <typename T>
double load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return static_cast<double>(value);
}

double component(int type, const char* at) {
    switch (type) {
        case kByte:
            return load<std::int8_t>(at);
        case kUnsignedByte:
            return load<std::uint8_t>(at);
        case kShort:
            return load<std::int16_t>(at);
        case kUnsignedShort:
            return load<std::uint16_t>(at);
        case kUnsignedInt:
            return load<std::uint32_t>(at);
        default:
            return load<float>(at);
    }
}

std::uint32_t word(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// Splits a GLB container (glTF 2.0 specification, 4.4) into its JSON and its binary chunk.
std::string_view split_glb(std::string_view bytes, std::optional<std::string_view>& binary) {
    constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
    if (bytes.size() < 20) throw FormatError("GLB is truncated: shorter than its header");
    if (word(bytes, 4) != 2)
        throw FormatError(fmt::format("GLB version {} is not 2", word(bytes, 4)));
    if (word(bytes, 8) > bytes.size())
        throw FormatError(
            fmt::format("GLB is truncated: {} of {} bytes", bytes.size(), word(bytes, 8)));
    std::optional<std::string_view> text;
    for (std::size_t at = 12; bytes.size() - at >= 8;) {
        const std::size_t size = word(bytes, at);
        const std::uint32_t type = word(bytes, at + 4);
        at += 8;
        if (size > bytes.size() - at)
            throw FormatError(fmt::format("GLB chunk at byte {} has {} bytes, with {} left", at - 8,
                                          size, bytes.size() - at));
        if (type == kJson && !text) text = bytes.substr(at, size);
        if (type == kBinary && !binary) binary = bytes.substr(at, size);
        at += size;
    }
    if (!text) throw FormatError("GLB has no JSON chunk");
    return *text;
}

/// The bytes of "data:...;base64,..." (white space is not allowed in it, RFC 2397).
std::string decode_base64(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= 'A' && c <= 'Z') return c - 'A';
        if (c >= 'a' && c <= 'z') return c - 'a' + 26;
        if (c >= '0' && c <= '9') return c - '0' + 52;
        return c == '+' ? 62 : c == '/' ? 63 : -1;
    };
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::string bytes;
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        if (digit(c) < 0) throw FormatError("glTF data URI is not valid base64");
        bits = (bits << 6 | static_cast<std::uint32_t>(digit(c))) & 0xffff;
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes += static_cast<char>(bits >> bit_count & 0xff);
    }
    return bytes;
}

std::string decode_percent(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded = uri[i] == '%' && i + 2 < uri.size() &&
                           std::isxdigit(uri[i + 1] & 0xff) && std::isxdigit(uri[i + 2] & 0xff);
        text += coded ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
        if (coded) i += 2;
    }
    return text;
}

}  // namespace

std::size_t natural(const json& value, std::string_view what) {
    constexpr std::uint64_t kMax = std::uint64_t{1} << 53;
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMax)
        throw FormatError(fmt::format("glTF {} is not a natural number", what));
    return value.get<std::size_t>();
}

std::size_t natural_or(const json& object, const char* key, std::size_t fallback) {
    const auto it = object.find(key);
    return it == object.end() ? fallback : natural(*it, key);
}

const json& item(const json& root, const char* list, std::size_t index) {
    const auto it = root.find(list);
    const std::size_t size = it == root.end() ? 0 : it->size();
    if (size <= index || !it->is_array() || !(*it)[index].is_object())
        throw FormatError(
            fmt::format("glTF refers to item {} of '{}', which has {}", index, list, size));
    return (*it)[index];
}

GltfData::GltfData(std::string_view bytes, std::filesystem::path folder)
    : folder_(std::move(folder)) {
    const bool binary = bytes.substr(0, 4) == "glTF";
    root_ = json::parse(binary ? split_glb(bytes, binary_chunk_) : bytes);
    if (!root_.is_object() || !root_.contains("asset"))
        throw FormatError("is not a glTF file: it has no 'asset'");
    if (const std::string version = root_["asset"].value("version", ""); !version.starts_with("2"))
        throw FormatError(fmt::format("glTF version '{}' is not 2", version.substr(0, 40)));
}

std::string_view GltfData::buffer(std::size_t index) {
    const json& description = item(root_, "buffers", index);
    const std::size_t size = natural(description.at("byteLength"), "byteLength");
    loaded_.resize(std::max(loaded_.size(), index + 1));
    std::string_view bytes;
    if (loaded_[index]) {
        bytes = *loaded_[index];
    } else if (const auto it = description.find("uri"); it != description.end()) {
        const auto& uri = it->get_ref<const std::string&>();
        const std::size_t comma = uri.find(";base64,");
        if (uri.starts_with("data:") && comma != uri.npos) {
            loaded_[index] = decode_base64(std::string_view(uri).substr(comma + 8));
        } else {
            const std::filesystem::path path = folder_ / decode_percent(uri);
            try {
                loaded_[index] = read_bytes(path, false);
            } catch (const FormatError& error) {
                throw FormatError(
                    fmt::format("glTF buffer {} ({}) {}", index, path.string(), error.what()));
            }
        }
        bytes = *loaded_[index];
    } else if (index == 0 && binary_chunk_) {
        bytes = *binary_chunk_;
    } else {
        throw FormatError(fmt::format("glTF buffer {} has neither a uri nor a GLB chunk", index));
    }
    if (bytes.size() < size)
        throw FormatError(
            fmt::format("glTF buffer {} is truncated: {} of {} bytes", index, bytes.size(), size));
    return bytes.substr(0, size);
}

std::vector<double> GltfData::values(const Layout& layout, std::string_view what) {
    const json& view = item(root_, "bufferViews", layout.view);
    const std::string_view bytes = buffer(natural(view.at("buffer"), "bufferView.buffer"));
    const std::size_t view_offset = natural_or(view, "byteOffset", 0);
    const std::size_t view_size = natural(view.at("byteLength"), "bufferView.byteLength");
    const std::size_t element = layout.components * component_size(layout.component_type);
    const std::size_t stride = natural_or(view, "byteStride", element);
    const bool view_fits = view_offset <= bytes.size() && view_size <= bytes.size() - view_offset;
    // The last element ends at offset + (count - 1) * stride + element.
    const bool fits =
        layout.count == 0 || (layout.offset + element <= view_size && stride >= element &&
                              layout.count - 1 <= (view_size - layout.offset - element) / stride);
    if (!view_fits || !fits)
        throw FormatError(
            fmt::format("glTF {} of {} elements, {} bytes apart from byte {}, does not "
                        "fit buffer view {} of {} bytes",
                        what, layout.count, stride, layout.offset, layout.view, view_size));
    std::vector<double> values;
    values.reserve(layout.count * layout.components);
    for (std::size_t i = 0; i < layout.count; ++i) {
        const char* at = bytes.data() + view_offset + layout.offset + i * stride;
        for (std::size_t k = 0; k < layout.components; ++k)
            values.push_back(
                component(layout.component_type, at + k * component_size(layout.component_type)));
    }
    return values;
}

std::vector<double> GltfData::accessor_values(std::size_t index, std::string_view type) {
    const json& accessor = item(root_, "accessors", index);
    const std::string what = fmt::format("accessor {}", index);
    if (accessor.at("type").get_ref<const std::string&>() != type)
        throw FormatError(fmt::format("glTF {} is not of type {}", what, type));
    if (!accessor.contains("bufferView"))
        throw FormatError(fmt::format("glTF {} has no buffer view (compressed data?)", what));
    const std::size_t components = type == "VEC3" ? 3 : 1;
    const auto component_type =
        static_cast<int>(natural(accessor.at("componentType"), "componentType"));
    const std::size_t count = natural(accessor.at("count"), "accessor.count");
    std::vector<double> result =
        values({natural(accessor["bufferView"], "accessor.bufferView"),
                natural_or(accessor, "byteOffset", 0), count, component_type, components},
               what);

    if (const auto it = accessor.find("sparse"); it != accessor.end()) {
        const std::size_t sparse_count = natural(it->at("count"), "sparse.count");
        const json& places = it->at("indices");
        const std::vector<double> at =
            values({natural(places.at("bufferView"), "sparse.indices.bufferView"),
                    natural_or(places, "byteOffset", 0), sparse_count,
                    static_cast<int>(natural(places.at("componentType"), "componentType")), 1},
                   what + "'s sparse index list");
        const json& replacements = it->at("values");
        const std::vector<double> with = values(
            {natural(replacements.at("bufferView"), "sparse.values.bufferView"),
             natural_or(replacements, "byteOffset", 0), sparse_count, component_type, components},
            what + "'s sparse value list");
        for (std::size_t i = 0; i < sparse_count; ++i) {
            if (!(at[i] >= 0 && at[i] < static_cast<double>(count)))
                throw FormatError(
                    fmt::format("glTF {} replaces element {} of {}", what, at[i], count));
            for (std::size_t k = 0; k < components; ++k)
                result[static_cast<std::size_t>(at[i]) * components + k] = with[i * components + k];
        }
    }
    // Normalised integers stand for [0, 1] or [-1, 1] (glTF 2.0 specification, 3.6.2.2).
    if (accessor.value("normalized", false) && component_type < kUnsignedInt) {
        constexpr std::array<double, 4> kScale = {127, 255, 32767, 65535};
        for (double& value : result)
            value =
                std::max(value / kScale[static_cast<std::size_t>(component_type - kByte)], -1.0);
    }
    return result;
}

std::vector<glm::vec3> GltfData::positions(std::size_t accessor) {
    const std::vector<double> values = accessor_values(accessor, "VEC3");
    std::vector<glm::vec3> positions(values.size() / 3);
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = glm::dvec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    return positions;
}

std::vector<std::uint32_t> GltfData::indices(std::size_t accessor) {
    const std::vector<double> values = accessor_values(accessor, "SCALAR");
    std::vector<std::uint32_t> indices;
    indices.reserve(values.size());
    for (const double value : values) {
        if (!(value >= 0 && value <= 0xffffffff))
            throw FormatError(fmt::format("glTF accessor {} has {} as an index", accessor, value));
        indices.push_back(static_cast<std::uint32_t>(value));
    }
    return indices;
}

}  // namespace experiments::scenes
