// The Morton curve (G. M. Morton, 1966) through the centroids, in cells of 2^-21 of the scene's
// largest extent; chunks of it to k_means.cpp; each part gets its volume.
#include "structures/metric_tree/clustering.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "structures/metric_tree/k_means.hpp"
#include "structures/metric_tree/volume.hpp"

namespace structures::metric_tree {
namespace {

using geometry::TriangleMesh;
using Blocks = tbb::blocked_range<std::size_t>;

constexpr std::size_t kMaxTriangles = std::size_t{1} << 27;
constexpr std::size_t kChunk = KMeans::kElementsAtMost;
constexpr int kBits = 21;  ///< of a Morton code, for each axis
constexpr std::uint64_t kLeftOut = ~std::uint64_t{0};

struct Entry {
    std::uint64_t code;
    std::uint32_t triangle;
};

struct Box {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
};

glm::dvec3 centroid(const TriangleMesh& mesh, std::size_t triangle) {
    return (glm::dvec3(mesh.corner(triangle, 0)) + glm::dvec3(mesh.corner(triangle, 1)) +
            glm::dvec3(mesh.corner(triangle, 2))) /
           3.0;
}

/// Two zeros before each of 21 bits.
std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 32) & 0x001f00000000ffffu;
    bits = (bits | bits << 16) & 0x001f0000ff0000ffu;
    bits = (bits | bits << 8) & 0x100f00f00f00f00fu;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3u;
    bits = (bits | bits << 2) & 0x1249249249249249u;
    return bits;
}

/// Triangles that are not degenerate, along the curve.
std::vector<std::uint32_t> sorted_triangles(const TriangleMesh& mesh) {
    const std::size_t count = mesh.triangle_count();
    std::vector<Entry> entries(count);
    const auto look = [&](const Blocks& block, Box box) {
        for (std::size_t t = block.begin(); t < block.end(); ++t) {
            const bool degenerate = mesh.degenerate(t);
            entries[t] = {degenerate ? kLeftOut : 0, static_cast<std::uint32_t>(t)};
            if (degenerate) continue;
            const glm::dvec3 center = centroid(mesh, t);
            box.lower = glm::min(box.lower, center);
            box.upper = glm::max(box.upper, center);
        }
        return box;
    };
    const auto join = [](const Box& a, const Box& b) {
        return Box{glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)};
    };
    const Box bounds = tbb::parallel_reduce(Blocks(0, count, 4096), Box{}, look, join);

    const glm::dvec3 extent = bounds.upper - bounds.lower;
    const double largest = std::max({extent.x, extent.y, extent.z});
    const double cells = largest > 0 ? ((1 << kBits) - 1) / largest : 0;
    tbb::parallel_for(Blocks(0, count, 4096), [&](const Blocks& block) {
        for (std::size_t t = block.begin(); t < block.end(); ++t) {
            if (entries[t].code == kLeftOut) continue;
            const glm::u64vec3 cell((centroid(mesh, t) - bounds.lower) * cells);
            entries[t].code = spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z);
        }
    });
    tbb::parallel_sort(entries, [](const Entry& a, const Entry& b) {
        return a.code != b.code ? a.code < b.code : a.triangle < b.triangle;
    });
    while (!entries.empty() && entries.back().code == kLeftOut) entries.pop_back();
    std::vector<std::uint32_t> order(entries.size());
    std::transform(entries.begin(), entries.end(), order.begin(),
                   [](const Entry& entry) { return entry.triangle; });
    return order;
}

/// Passes on shares of the work done, each percent once, from whichever thread.
class Progress {
  public:
    Progress(const std::function<void(double)>& report, std::size_t total)
        : report_(report), total_(total) {}

    void finish_one() {
        if (!report_) return;
        const std::scoped_lock lock(mutex_);
        ++done_;
        const std::size_t percent = done_ * 100 / total_;
        if (percent > percent_) report_(static_cast<double>(done_) / static_cast<double>(total_));
        percent_ = percent;
    }

  private:
    const std::function<void(double)>& report_;
    std::size_t total_, done_ = 0, percent_ = 0;
    std::mutex mutex_;
};

}  // namespace

void check(const ClusterConfig& config) {
    if (config.max_triangles < 1 || config.max_triangles > 64)
        throw std::invalid_argument(fmt::format(
            "clustering: max_triangles is {}; it has to be from 1 to 64", config.max_triangles));
}

void check(const TriangleMesh& mesh) {
    if (mesh.triangle_count() >= kMaxTriangles)
        throw std::invalid_argument(
            fmt::format("clustering: the mesh has {} triangles; fewer than {} are possible",
                        mesh.triangle_count(), kMaxTriangles));
}

std::uint32_t count_capsules(const std::vector<Cluster>& clusters) {
    return static_cast<std::uint32_t>(
        std::count_if(clusters.begin(), clusters.end(),
                      [](const Cluster& cluster) { return cluster.a != cluster.b; }));
}

Clustering cluster(const TriangleMesh& mesh, const ClusterConfig& config,
                   const std::function<void(double)>& progress) {
    check(config);
    check(mesh);
    Clustering result;
    result.order = sorted_triangles(mesh);
    const std::size_t chunk_count = (result.order.size() + kChunk - 1) / kChunk;
    std::vector<std::vector<Cluster>> chunks(chunk_count);
    Progress share(progress, chunk_count);
    tbb::parallel_for(std::size_t{0}, chunk_count, [&](std::size_t c) {
        const std::size_t begin = c * kChunk;
        const std::span triangles =
            std::span(result.order).subspan(begin, std::min(kChunk, result.order.size() - begin));
        const KMeans parts(mesh, triangles, config.max_triangles, (config.seed << 32) + c);
        std::size_t first = 0;
        for (const std::uint32_t size : parts.part_sizes()) {
            chunks[c].push_back(fit_volume(mesh, triangles.subspan(first, size), config.capsules));
            chunks[c].back().first = static_cast<std::uint32_t>(begin + first);
            first += size;
        }
        share.finish_one();
    });
    std::size_t cluster_count = 0;
    for (const std::vector<Cluster>& chunk : chunks) cluster_count += chunk.size();
    result.clusters.reserve(cluster_count);
    for (std::vector<Cluster>& chunk : chunks) {
        result.clusters.insert(result.clusters.end(), chunk.begin(), chunk.end());
        chunk = {};
    }
    result.capsule_count = count_capsules(result.clusters);
    return result;
}

}  // namespace structures::metric_tree
