// Which edges of a mesh bound shadow, seen from the light.
//
//     Silhouette silhouette(mesh, light, casters);
//     bool outline = silhouette.multiplicity(silhouette.edge(t, k)) != 0;
//
// Vertices are welded by equal position. A triangle whose exact side is m (+1 or -1: the side of
// its plane on which the light lies; 0: the light is in the plane, and it casts nothing)
// contributes m along each of its three edges, as it runs through them. The sum over all triangles
// of an edge is its multiplicity: by how much the number of triangles between a point and the light
// changes when the point crosses the part of the edge's plane of light that lies behind the edge.
// It is 0 between two triangles that continue each other, whichever way they are wound. Meshes need
// not be closed, manifold or consistently wound: see "Fast and Robust Tessellation-Based Silhouette
// Shadows", WSCG 2014, which takes multiplicities the same way, but rounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace shadows::truth {

class Silhouette {
  public:
    /// Over the triangles `casters` of `mesh`; others contribute nothing.
    Silhouette(const structures::geometry::TriangleMesh& mesh,
               const structures::geometry::Light& light, std::span<const std::uint32_t> casters);

    /// Sign of N . (L - a), or of N . (-vector), for N = (b - a) x (c - a).
    int side(std::uint32_t triangle) const { return sides_[triangle]; }
    /// Edge from corner k to corner k + 1, an index shared by all triangles that have it.
    std::uint32_t edge(std::uint32_t triangle, int k) const { return edges_[triangle][k]; }
    bool has_edge(std::uint32_t triangle, std::uint32_t edge) const;
    int multiplicity(std::uint32_t edge) const { return multiplicities_[edge]; }
    /// Multiplicity of edge k of `triangle` once the triangle itself is taken away.
    int multiplicity_of_others(std::uint32_t triangle, int k) const;

  private:
    std::vector<std::int8_t> sides_;                   // of all triangles, 0 if no caster
    std::vector<std::array<std::uint32_t, 3>> edges_;  // of no edge if no caster
    std::vector<std::array<std::int8_t, 3>> runs_;     // +1: along the edge, -1: against it
    std::vector<int> multiplicities_;
};

}  // namespace shadows::truth
