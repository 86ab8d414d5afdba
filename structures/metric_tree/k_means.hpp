// Splits a few hundred triangles into parts of neighbours, by k-means again and again.
//
//     KMeans splitter(mesh, triangles, 16, seed);       // reorders `triangles`
//     for (std::uint32_t size : splitter.part_sizes())  // parts follow each other
//
// What is compared are the corners of bounding boxes, points in six dimensions. Deterministic.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "structures/geometry/triangle_mesh.hpp"

namespace structures::metric_tree {

class KMeans {
  public:
    static constexpr std::uint32_t kElementsAtMost = 512;

    /// Parts of at most `max_part` triangles out of at most kElementsAtMost with finite corners.
    KMeans(const geometry::TriangleMesh& mesh, std::span<std::uint32_t> triangles,
           std::uint32_t max_part, std::uint64_t seed);

    const std::vector<std::uint32_t>& part_sizes() const { return part_sizes_; }

  private:
    static constexpr std::uint32_t kMeansAtMost = 8, kCandidates = 8, kRounds = 4;
    static constexpr int kDimensions = 6;

    using Box = std::array<float, kDimensions>;
    struct Range {
        std::uint32_t begin, end;
    };

    void place(const geometry::TriangleMesh& mesh);
    std::vector<Range> split(Range range);
    void seed_means(Range range, std::uint32_t mean_count);
    void assign(Range range, std::uint32_t mean_count);
    bool move_means(Range range, std::uint32_t mean_count);
    std::vector<Range> gather_parts(Range range);
    Box box_of(std::uint32_t element) const;
    std::uint32_t random_below(std::uint32_t end);

    std::span<std::uint32_t> triangles_;
    std::uint32_t max_part_;
    std::uint64_t random_;
    std::vector<std::uint32_t> part_sizes_;
    // By element: position within the triangles. Coordinates are the chunk's own, 0 to 1.
    std::array<std::array<float, kElementsAtMost>, kDimensions> boxes_;
    std::array<float, kElementsAtMost> nearest_;         ///< squared distance to the nearest mean
    std::array<std::uint32_t, kElementsAtMost> labels_;  ///< that mean
    std::array<Box, kMeansAtMost> means_;
};

}  // namespace structures::metric_tree
