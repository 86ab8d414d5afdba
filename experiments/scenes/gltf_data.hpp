// The data side of a glTF 2.0 file: container, JSON, buffers and accessors, all bounds checked.
//
//     GltfData data(bytes, folder);
//     std::vector<glm::vec3> positions = data.positions(accessor_index);
//     std::vector<std::uint32_t> indices = data.indices(accessor_index);
//
// Functions throw FormatError, or nlohmann::json::exception where a JSON value has the wrong type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace experiments::scenes {

/// Counts and indices are up to 2^53 here, so that sums and products of two cannot overflow.
std::size_t natural(const nlohmann::json& value, std::string_view what);
/// The natural number at `key`, or `fallback` if the key is absent.
std::size_t natural_or(const nlohmann::json& object, const char* key, std::size_t fallback);
/// `root[list][index]`, e.g. ("meshes", 3).
const nlohmann::json& item(const nlohmann::json& root, const char* list, std::size_t index);

class GltfData {
  public:
    /// `bytes` must outlive this object.
    GltfData(std::string_view bytes, std::filesystem::path folder);

    const nlohmann::json& root() const { return root_; }
    /// A VEC3 accessor of floats, or of integers as KHR_mesh_quantization allows.
    std::vector<glm::vec3> positions(std::size_t accessor);
    /// A SCALAR accessor of unsigned integers.
    std::vector<std::uint32_t> indices(std::size_t accessor);

  private:
    struct Layout {
        std::size_t view, offset, count;
        int component_type;
        std::size_t components;
    };

    std::string_view buffer(std::size_t index);
    std::vector<double> values(const Layout& layout, std::string_view what);
    std::vector<double> accessor_values(std::size_t index, std::string_view type);

    nlohmann::json root_;
    std::filesystem::path folder_;
    std::optional<std::string_view> binary_chunk_;
    std::vector<std::optional<std::string>> loaded_;  ///< buffers outside the file, once read
};

}  // namespace experiments::scenes
