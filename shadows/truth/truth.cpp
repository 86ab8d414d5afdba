// The public side of the judge: checks what comes in, and hands the points to all cores.
#include "shadows/truth/truth.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "shadows/truth/scene.hpp"

namespace shadows::truth {

using structures::geometry::Light;
using structures::geometry::TriangleMesh;

Effort& Effort::operator+=(const Effort& other) {
    filtered += other.filtered;
    exact += other.exact;
    candidates += other.candidates;
    milliseconds += other.milliseconds;
    return *this;
}

Truth::Truth(const TriangleMesh& mesh, const Light& light)
    : scene_(std::make_unique<const Scene>(mesh, light)) {}

Truth::~Truth() = default;

Verdicts Truth::judge(const PointArrays& points, const JudgeOptions& options) const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const std::size_t count = points.x.size();
    const auto position = [&](std::size_t i) {
        return glm::vec3(points.x[i], points.y[i], points.z[i]);
    };
    if (points.y.size() != count || points.z.size() != count || points.primitive.size() != count ||
        points.normal.size() != count)
        throw std::invalid_argument("Truth: the arrays of points differ in length");
    for (std::size_t i = 0; i < count; ++i)
        if (points.primitive[i] != kNoPrimitive) scene_->check(position(i), points.primitive[i], i);

    // Threads take tiles as they go; this one works too, and reports.
    Verdicts verdicts;
    verdicts.points.resize(count);
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> stopped = false;
    const auto judge_tile = [&](Effort& effort) {
        const std::size_t first = next.fetch_add(kTilePoints);
        if (first >= count || stopped) return false;
        for (std::size_t i = first; i < std::min(first + kTilePoints, count); ++i)
            if (points.primitive[i] != kNoPrimitive)
                verdicts.points[i] =
                    scene_->judge(position(i), points.primitive[i], points.normal[i], effort);
        return true;
    };
    const unsigned threads =
        options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    if (options.progress && !options.progress(0)) stopped = true;
    std::vector<Effort> efforts(threads);
    {
        std::vector<std::jthread> helpers;
        for (unsigned i = 1; i < threads; ++i)
            helpers.emplace_back([&, i] {
                Effort effort;
                while (judge_tile(effort)) continue;
                efforts[i] = effort;
            });
        try {
            while (judge_tile(efforts[0])) {
                const double done = double(std::min(next.load(), count)) / double(count);
                if (options.progress && !options.progress(done)) stopped = true;
            }
        } catch (...) {
            stopped = true;
            throw;
        }
    }
    if (stopped) throw std::runtime_error("Truth: stopped before all points were judged");
    for (const Effort& effort : efforts) verdicts.effort += effort;
    verdicts.effort.milliseconds =
        std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    return verdicts;
}

bool Truth::shadowed(glm::vec3 p, std::uint32_t own) const {
    scene_->check(p, own, 0);
    return scene_->shadowed(p, own);
}

double Truth::epsilon(glm::vec3 p) const { return scene_->epsilon(p); }

bool Truth::changes_nearby(glm::vec3 p, std::uint32_t own, double radius) const {
    const bool here = shadowed(p, own);
    // Rounded offsets must not end up farther away than asked for.
    const double coordinate = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double reach = std::max(0.0, radius - 0x1p-22 * (coordinate + radius));
    for (int i = 0; i < 27; ++i) {
        // Of the 27 directions with components -1, 0 and 1: along the axes and to the corners.
        const glm::dvec3 direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        const double axes = glm::dot(direction, direction);
        if (axes != 1 && axes != 3) continue;
        const glm::dvec3 moved = glm::dvec3(p) + reach / std::sqrt(axes) * direction;
        if (shadowed(glm::vec3(moved), own) != here) return true;
    }
    return false;
}

}  // namespace shadows::truth
