// glTF 2.0 reader: walks the node tree of the default scene and puts every triangle primitive into
// world space. Skins and morph targets keep their bind pose; a mesh used by several nodes is
// copied.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>

#include "experiments/scenes/gltf_data.hpp"
#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

using nlohmann::json;

enum Mode { kTriangles = 4, kTriangleStrip, kTriangleFan };

/// Extensions under which positions or indices would be read wrongly.
constexpr std::array<const char*, 4> kUnreadable = {
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
    "EXT_mesh_gpu_instancing"};

template <int kSize>
std::array<double, kSize> numbers(const json& node, const char* key,
                                  const std::array<double, kSize>& fallback) {
    const auto it = node.find(key);
    if (it == node.end()) return fallback;
    if (!it->is_array() || it->size() != kSize)
        throw FormatError(fmt::format("glTF node's '{}' is not a list of {} numbers", key, kSize));
    return it->get<std::array<double, kSize>>();
}

glm::dmat4 local_transform(const json& node) {
    if (node.contains("matrix")) {
        const auto m = numbers<16>(node, "matrix", {});
        glm::dmat4 matrix;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) matrix[column][row] = m[4 * column + row];
        return matrix;
    }
    const auto t = numbers<3>(node, "translation", {0, 0, 0});
    const auto r = numbers<4>(node, "rotation", {0, 0, 0, 1});  // x y z w
    const auto s = numbers<3>(node, "scale", {1, 1, 1});
    glm::dmat4 matrix = glm::mat4_cast(glm::dquat(r[3], r[0], r[1], r[2]));
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[axis];
    matrix[3] = glm::dvec4(t[0], t[1], t[2], 1);
    return matrix;
}

class Reader {
  public:
    Reader(std::string_view bytes, const std::filesystem::path& folder, LoadedMesh& scene)
        : data_(bytes, folder), root_(data_.root()), scene_(scene) {}

    void read() {
        for (const char* extension : kUnreadable) {
            const json required = root_.value("extensionsRequired", json::array());
            if (std::find(required.begin(), required.end(), extension) != required.end())
                throw FormatError(
                    fmt::format("needs the glTF extension {}, which is not supported: "
                                "export without it",
                                extension));
        }
        // A list rather than recursion: a chain of nodes may be as long as the file.
        for (const std::size_t root : root_nodes()) open_.push_back({root, glm::dmat4(1)});
        std::reverse(open_.begin(), open_.end());
        while (!open_.empty()) {
            const auto [node, parent] = open_.back();
            open_.pop_back();
            visit(node, parent);
        }
    }

  private:
    struct OpenNode {
        std::size_t index;
        glm::dmat4 parent;
    };

    /// Those of the default scene; without any scene, the nodes that are nobody's children.
    std::vector<std::size_t> root_nodes() const {
        std::vector<std::size_t> roots;
        if (root_.contains("scenes")) {
            const json& scene = item(root_, "scenes", natural_or(root_, "scene", 0));
            for (const json& node : scene.value("nodes", json::array()))
                roots.push_back(natural(node, "scene node"));
            return roots;
        }
        const json nodes = root_.value("nodes", json::array());
        std::set<std::size_t> children;
        for (const json& node : nodes)
            for (const json& child : node.value("children", json::array()))
                children.insert(natural(child, "node child"));
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (!children.contains(i)) roots.push_back(i);
        return roots;
    }

    void visit(std::size_t index, const glm::dmat4& parent) {
        const json& node = item(root_, "nodes", index);
        if (!visited_.insert(index).second)
            throw FormatError(
                fmt::format("glTF node {} has two parents or is its own ancestor", index));
        const glm::dmat4 transform = parent * local_transform(node);
        if (node.contains("mesh"))
            add_mesh(item(root_, "meshes", natural(node["mesh"], "node.mesh")), transform);
        const json children = node.value("children", json::array());
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            open_.push_back({natural(*child, "node child"), transform});
    }

    void add_mesh(const json& mesh, const glm::dmat4& transform) {
        std::map<std::size_t, std::size_t> first_vertex;  // by accessor: primitives may share one
        for (const json& primitive : mesh.at("primitives")) {
            const std::size_t mode = natural_or(primitive, "mode", kTriangles);
            const json& attributes = primitive.at("attributes");
            if (mode < kTriangles || mode > kTriangleFan || !attributes.contains("POSITION")) {
                ++scene_.report.skipped;
                continue;
            }
            const std::size_t accessor = natural(attributes["POSITION"], "POSITION");
            const auto [it, is_new] = first_vertex.emplace(accessor, scene_.mesh.positions.size());
            const std::size_t vertex_count =
                natural(item(root_, "accessors", accessor).at("count"), "accessor.count");
            if (is_new) add_positions(accessor, transform);
            add_primitive(primitive, mode, it->second, vertex_count,
                          glm::determinant(glm::dmat3(transform)) < 0);
        }
    }

    void add_positions(std::size_t accessor, const glm::dmat4& transform) {
        const std::vector<glm::vec3> local = data_.positions(accessor);
        if (scene_.mesh.positions.size() + local.size() >= 0xffffffffu)
            throw FormatError("glTF has more than 2^32 vertices once its meshes are placed");
        for (const glm::vec3 p : local)
            scene_.mesh.positions.emplace_back(glm::dvec3(transform * glm::dvec4(p, 1)));
    }

    /// A mirroring transform turns the winding around (glTF 2.0 specification, 3.7.4).
    void add_primitive(const json& primitive, std::size_t mode, std::size_t first_vertex,
                       std::size_t vertex_count, bool mirrored) {
        std::vector<std::uint32_t> corners;
        if (primitive.contains("indices")) {
            corners = data_.indices(natural(primitive["indices"], "primitive.indices"));
        } else {
            for (std::size_t i = 0; i < vertex_count; ++i)
                corners.push_back(static_cast<std::uint32_t>(i));
        }
        const std::size_t step = mode == kTriangles ? 3 : 1;
        for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
            std::array<std::size_t, 3> at = {i, i + 1, i + 2};
            if (mode == kTriangleFan) at[0] = 0;
            if ((mode == kTriangleStrip && i % 2 == 1) != mirrored) std::swap(at[1], at[2]);
            glm::uvec3 triangle;
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t corner = corners[at[k]];
                if (corner >= vertex_count)
                    throw FormatError(
                        fmt::format("triangle {} refers to vertex {} of a primitive "
                                    "that has {} (counted from 0)",
                                    scene_.mesh.triangles.size(), corner, vertex_count));
                triangle[k] = static_cast<std::uint32_t>(first_vertex + corner);
            }
            scene_.mesh.triangles.push_back(triangle);
        }
    }

    GltfData data_;
    const json& root_;
    LoadedMesh& scene_;
    std::vector<OpenNode> open_;
    std::set<std::size_t> visited_;
};

}  // namespace

void read_gltf(std::string_view bytes, const std::filesystem::path& folder, LoadedMesh& scene) {
    try {
        Reader(bytes, folder, scene).read();
    } catch (const json::exception& error) {
        throw FormatError(fmt::format("malformed glTF: {}", error.what()));
    }
}

}  // namespace experiments::scenes
