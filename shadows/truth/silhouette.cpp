// Welding and counting: vertices are sorted by position, then the uses of edges by their vertices.
#include "shadows/truth/silhouette.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "shadows/truth/exact.hpp"

namespace shadows::truth {
namespace {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

/// The edges of a triangle that casts nothing.
constexpr std::uint32_t kNoEdge = 0xffffffffu;

/// The bits of a position; -0 counts as 0.
std::array<std::uint32_t, 3> key_of(const glm::vec3& v) {
    return {std::bit_cast<std::uint32_t>(v.x + 0.0f), std::bit_cast<std::uint32_t>(v.y + 0.0f),
            std::bit_cast<std::uint32_t>(v.z + 0.0f)};
}

/// For each vertex, a number that equal positions share.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size()), welded(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return key_of(positions[a]) < key_of(positions[b]);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && key_of(positions[order[i]]) == key_of(positions[order[i - 1]]);
        welded[order[i]] = same ? welded[order[i - 1]] : order[i];
    }
    return welded;
}

/// One triangle's use of an edge.
struct Use {
    std::uint64_t vertices;  // the two welded vertices, lesser one first
    std::uint32_t triangle;
    std::uint8_t k;
    std::int8_t run;
};

}  // namespace

Silhouette::Silhouette(const TriangleMesh& mesh, const Light& light,
                       std::span<const std::uint32_t> casters)
    : sides_(mesh.triangle_count()),
      edges_(mesh.triangle_count(), {kNoEdge, kNoEdge, kNoEdge}),
      runs_(mesh.triangle_count()) {
    const std::vector<std::uint32_t> welded = weld(mesh.positions);
    std::vector<Use> uses;
    Signs signs;
    uses.reserve(3 * casters.size());
    for (const std::uint32_t t : casters) {
        const glm::vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        // det(a - L, b - L, c - L) = N . (a - L).
        const int sign = light.type == Light::Type::directional
                             ? orientation_towards(b, c, light.vector, a, signs)
                             : orientation(a, b, c, light.vector, signs);
        sides_[t] = static_cast<std::int8_t>(-sign);
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint64_t from = welded[mesh.triangles[t][k]];
            const std::uint64_t to = welded[mesh.triangles[t][(k + 1) % 3]];
            const std::int8_t run = from < to ? 1 : -1;
            uses.push_back({std::min(from, to) << 32 | std::max(from, to), t, k, run});
            runs_[t][k] = run;
        }
    }
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return a.vertices != b.vertices ? a.vertices < b.vertices : a.triangle < b.triangle;
    });
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (i == 0 || uses[i].vertices != uses[i - 1].vertices) multiplicities_.push_back(0);
        multiplicities_.back() += sides_[uses[i].triangle] * uses[i].run;
        edges_[uses[i].triangle][uses[i].k] =
            static_cast<std::uint32_t>(multiplicities_.size() - 1);
    }
}

bool Silhouette::has_edge(std::uint32_t triangle, std::uint32_t edge) const {
    const auto& own = edges_[triangle];
    return std::find(own.begin(), own.end(), edge) != own.end();
}

int Silhouette::multiplicity_of_others(std::uint32_t triangle, int k) const {
    const std::uint32_t edge = edges_[triangle][k];
    return edge == kNoEdge ? 0 : multiplicities_[edge] - sides_[triangle] * runs_[triangle][k];
}

}  // namespace shadows::truth
