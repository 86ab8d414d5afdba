// What the paper leaves open: the number of means is what would do if parts came out full, at most
// 8; each next one begins at the candidate, of 8 drawn, that is farthest from those before it (T.
// Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985, by sampling); then 4
// rounds.
#include "structures/metric_tree/k_means.hpp"

#include <algorithm>
#include <limits>

namespace structures::metric_tree {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <typename Box>
float square_between(const Box& a, const Box& b) {
    float sum = 0;
    for (std::size_t d = 0; d < a.size(); ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
}

}  // namespace

KMeans::KMeans(const geometry::TriangleMesh& mesh, std::span<std::uint32_t> triangles,
               std::uint32_t max_part, std::uint64_t seed)
    : triangles_(triangles), max_part_(max_part), random_(seed) {
    if (triangles.empty()) return;
    place(mesh);
    std::vector<Range> open{{0, static_cast<std::uint32_t>(triangles.size())}};
    while (!open.empty()) {
        const Range range = open.back();
        open.pop_back();
        if (range.end - range.begin <= max_part_) {
            part_sizes_.push_back(range.end - range.begin);
            continue;
        }
        const std::vector<Range> parts = split(range);
        open.insert(open.end(), parts.rbegin(), parts.rend());
    }
}

/// Boxes relative to the chunk's corner and size: differences neither overflow nor vanish.
void KMeans::place(const geometry::TriangleMesh& mesh) {
    geometry::Aabb bounds;
    for (const std::uint32_t triangle : triangles_) bounds.grow(mesh.triangle_bounds(triangle));
    const glm::dvec3 corner = bounds.lower, extent = glm::dvec3(bounds.upper) - corner;
    const double scale = 1 / std::max({extent.x, extent.y, extent.z});
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const geometry::Aabb box = mesh.triangle_bounds(triangles_[i]);
        for (int d = 0; d < 3; ++d) {
            boxes_[d][i] = static_cast<float>((box.lower[d] - corner[d]) * scale);
            boxes_[d + 3][i] = static_cast<float>((box.upper[d] - corner[d]) * scale);
        }
    }
}

std::vector<KMeans::Range> KMeans::split(Range range) {
    const std::uint32_t count = range.end - range.begin;
    const std::uint32_t mean_count = std::min(kMeansAtMost, (count + max_part_ - 1) / max_part_);
    seed_means(range, mean_count);
    assign(range, mean_count);
    for (std::uint32_t round = 0; round < kRounds && move_means(range, mean_count); ++round)
        assign(range, mean_count);
    std::vector<Range> parts = gather_parts(range);
    if (parts.size() > 1) return parts;
    // All alike: by their order, which is the Morton curve's.
    parts.clear();
    for (std::uint32_t m = 0; m < mean_count; ++m)
        parts.push_back(
            {range.begin + m * count / mean_count, range.begin + (m + 1) * count / mean_count});
    return parts;
}

void KMeans::seed_means(Range range, std::uint32_t mean_count) {
    const std::uint32_t count = range.end - range.begin;
    means_[0] = box_of(range.begin + random_below(count));
    for (std::uint32_t m = 1; m < mean_count; ++m) {
        float farthest = -1;
        for (std::uint32_t c = 0; c < kCandidates; ++c) {
            const Box candidate = box_of(range.begin + random_below(count));
            float nearest = kInfinity;
            for (std::uint32_t before = 0; before < m; ++before)
                nearest = std::min(nearest, square_between(candidate, means_[before]));
            if (nearest <= farthest) continue;
            farthest = nearest;
            means_[m] = candidate;
        }
    }
}

/// Every element to its nearest mean; of equally near ones to the first.
void KMeans::assign(Range range, std::uint32_t mean_count) {
    for (std::uint32_t m = 0; m < mean_count; ++m) {
        const Box mean = means_[m];
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            float square = 0;
            for (int d = 0; d < kDimensions; ++d)
                square += (boxes_[d][i] - mean[d]) * (boxes_[d][i] - mean[d]);
            const bool nearer = m == 0 || square < nearest_[i];
            nearest_[i] = nearer ? square : nearest_[i];
            labels_[i] = nearer ? m : labels_[i];
        }
    }
}

/// Means to the middle of their elements; one without elements to the element farthest from its
/// mean. False if none moved.
bool KMeans::move_means(Range range, std::uint32_t mean_count) {
    std::array<Box, kMeansAtMost> sums{};
    std::array<std::uint32_t, kMeansAtMost> counts{};
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        ++counts[labels_[i]];
        for (int d = 0; d < kDimensions; ++d) sums[labels_[i]][d] += boxes_[d][i];
    }
    bool moved = false;
    for (std::uint32_t m = 0; m < mean_count; ++m) {
        Box mean;
        if (counts[m] > 0) {
            for (int d = 0; d < kDimensions; ++d)
                mean[d] = sums[m][d] / static_cast<float>(counts[m]);
        } else {
            float* const farthest = std::max_element(&nearest_[range.begin], &nearest_[range.end]);
            mean = box_of(static_cast<std::uint32_t>(farthest - nearest_.data()));
            *farthest = 0;
        }
        moved |= mean != means_[m];
        means_[m] = mean;
    }
    return moved;
}

/// Brings the elements of each mean together, in the order they had; parts by their first element.
std::vector<KMeans::Range> KMeans::gather_parts(Range range) {
    std::array<std::uint32_t, kMeansAtMost> counts{}, order{}, next{};
    std::uint32_t found = 0;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        if (counts[labels_[i]]++ == 0) order[found++] = labels_[i];
    std::vector<Range> parts;
    for (std::uint32_t p = 0, begin = range.begin; p < found; ++p) {
        next[order[p]] = begin;
        parts.push_back({begin, begin + counts[order[p]]});
        begin = parts.back().end;
    }
    if (parts.size() < 2) return parts;

    std::array<std::uint32_t, kElementsAtMost> target;
    for (std::uint32_t i = range.begin; i < range.end; ++i) target[i] = next[labels_[i]]++;
    const auto move = [&](auto* values, auto* scratch) {
        for (std::uint32_t i = range.begin; i < range.end; ++i) scratch[target[i]] = values[i];
        std::copy(scratch + range.begin, scratch + range.end, values + range.begin);
    };
    std::array<std::uint32_t, kElementsAtMost> triangles;
    move(triangles_.data(), triangles.data());
    for (auto& coordinates : boxes_) move(coordinates.data(), nearest_.data());
    return parts;
}

KMeans::Box KMeans::box_of(std::uint32_t element) const {
    Box box;
    for (int d = 0; d < kDimensions; ++d) box[d] = boxes_[d][element];
    return box;
}

/// G. Steele, D. Lea and C. Flood, "Fast splittable pseudorandom number generators", 2014.
std::uint32_t KMeans::random_below(std::uint32_t end) {
    std::uint64_t z = random_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::uint32_t>(((z ^ (z >> 31)) >> 32) * end >> 32);
}

}  // namespace structures::metric_tree
