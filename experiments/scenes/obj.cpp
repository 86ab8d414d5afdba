// OBJ reader: positions and faces; texture coordinates, normals, groups and materials do not matter
// here. Fields may be separated by any blanks, lines may end in "\n" or "\r\n" and be continued
// with a backslash, indices may count back from the latest vertex.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "experiments/scenes/readers.hpp"

namespace experiments::scenes {
namespace {

/// Statements that say nothing about the surface.
constexpr std::array<std::string_view, 14> kIgnored = {
    "vt",     "vn", "vp",    "g",   "o",      "s",      "usemtl",
    "mtllib", "mg", "bevel", "lod", "usemap", "maplib", "d_interp"};

constexpr std::string_view kBlanks = " \t\r";

class Reader {
  public:
    explicit Reader(std::string_view bytes, LoadedMesh& scene) : bytes_(bytes), scene_(scene) {}

    void read() {
        std::string joined;
        for (std::size_t at = 0; at < bytes_.size();) {
            std::string_view line = take_line(at);
            if (continues(line)) {
                joined.clear();
                while (continues(line)) {
                    joined.append(line.substr(0, line.find_last_of('\\'))).append(" ");
                    line = at < bytes_.size() ? take_line(at) : std::string_view();
                }
                line = joined.append(line);
            }
            read_statement(line);
        }
        add_faces();
    }

  private:
    struct Face {
        std::size_t end;   ///< where its corners end in corners_
        std::size_t line;  ///< for messages
    };

    std::string_view take_line(std::size_t& at) {
        const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
        const std::string_view line = bytes_.substr(at, end - at);
        at = end + 1;
        ++line_;
        return line;
    }

    static bool continues(std::string_view line) {
        const std::size_t last = line.find_last_not_of(kBlanks);
        return last != line.npos && line[last] == '\\';
    }

    static std::string_view take_word(std::string_view& rest) {
        const std::size_t begin = std::min(rest.find_first_not_of(kBlanks), rest.size());
        const std::size_t end = std::min(rest.find_first_of(kBlanks, begin), rest.size());
        const std::string_view word = rest.substr(begin, end - begin);
        rest.remove_prefix(end);
        return word;
    }

    void read_statement(std::string_view rest) {
        const std::string_view keyword = take_word(rest);
        if (keyword == "v")
            read_vertex(rest);
        else if (keyword == "f")
            read_face(rest);
        else if (!keyword.empty() && keyword[0] != '#' &&
                 std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end())
            ++scene_.report.skipped;  // points, lines, curves, free-form surfaces
    }

    void read_vertex(std::string_view rest) {
        glm::vec3 position(0);
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = take_word(rest);
            const char* const end = word.data() + word.size();
            if (word.empty() || parse_float(word.data(), end, position[axis]) != end)
                throw FormatError(fmt::format("line {}: '{}' is no {} coordinate of a vertex",
                                              line_, word.substr(0, 40), "xyz"[axis]));
        }
        scene_.mesh.positions.push_back(position);
    }

    /// A corner is "position", "position/texture", "position//normal" or "position/texture/normal".
    void read_face(std::string_view rest) {
        for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#';
             word = take_word(rest)) {
            std::int64_t index = 0;
            const auto [stop, code] =
                std::from_chars(word.data(), word.data() + word.size(), index);
            if (code != std::errc() || (stop != word.data() + word.size() && *stop != '/'))
                throw FormatError(
                    fmt::format("line {}: '{}' is no face corner", line_, word.substr(0, 40)));
            const auto known = static_cast<std::int64_t>(scene_.mesh.positions.size());
            if (index == 0 || index < -known || index > std::int64_t{0xffffffff})
                throw FormatError(
                    fmt::format("line {}: face {} refers to vertex {}, with {} vertices "
                                "before it",
                                line_, faces_.size() + 1, index, known));
            corners_.push_back(static_cast<std::uint32_t>(index < 0 ? known + index : index - 1));
        }
        faces_.push_back({corners_.size(), line_});
    }

    /// Only now are all vertices there: a face may come before them.
    void add_faces() {
        const std::size_t vertex_count = scene_.mesh.positions.size();
        scene_.mesh.triangles.reserve(faces_.size());
        std::size_t begin = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            const auto corners = std::span(corners_).subspan(begin, faces_[i].end - begin);
            begin = faces_[i].end;
            for (const std::uint32_t corner : corners)
                if (corner >= vertex_count)
                    throw FormatError(
                        fmt::format("line {}: face {} refers to vertex {}, but there "
                                    "are {} (counted from 1)",
                                    faces_[i].line, i + 1, std::size_t{corner} + 1, vertex_count));
            add_polygon(corners, scene_);
        }
    }

    std::string_view bytes_;
    LoadedMesh& scene_;
    std::size_t line_ = 0;
    std::vector<std::uint32_t> corners_;
    std::vector<Face> faces_;
};

}  // namespace

void read_obj(std::string_view bytes, LoadedMesh& scene) { Reader(bytes, scene).read(); }

}  // namespace experiments::scenes
