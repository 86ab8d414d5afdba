// A tangle of pipes in a box: axis-aligned runs joined by round elbows, one pipe at most in each
// cell of a grid, so that they pass close by but never through each other.
#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/scenes/generator_rows.hpp"
#include "experiments/scenes/shapes.hpp"

namespace experiments::scenes {
namespace {

using structures::Parameter;
using structures::Settings;

std::span<const Parameter> parameters() {
    static const Parameter list[] = {
        triangles_parameter("pipes are added until there"),
        {"sides", std::int64_t{12}, "sides of a pipe", {}, 3, 64},
        {"turn", 0.3, "chance of an elbow in a cell", {}, 0.01, 1},
        {"fill", 0.3, "largest share of the cells that pipes take", {}, 0.01, 0.5},
        {"seed", std::int64_t{1}, "random seed"},
    };
    return list;
}

constexpr int kMaxLength = 60;  // cells of one pipe

/// Elbows are as round along as the pipe is around, and turn by 45 degrees at most at a time: the
/// frame carried along a tube is lost where its axis turns by 90.
std::size_t elbow_steps(std::size_t sides) { return std::max<std::size_t>(2, sides / 4 + 1); }

/// Cubic grid of free and taken cells.
class Grid {
  public:
    explicit Grid(int size) : size_(size), taken_(std::size_t(size) * size * size) {}
    int size() const { return size_; }
    bool is_free(glm::ivec3 cell) const {
        for (int axis = 0; axis < 3; ++axis)
            if (cell[axis] < 0 || cell[axis] >= size_) return false;
        return !taken_[index(cell)];
    }
    void take(glm::ivec3 cell) { taken_[index(cell)] = true; }

  private:
    std::size_t index(glm::ivec3 cell) const {
        return (std::size_t(cell.z) * size_ + cell.y) * size_ + cell.x;
    }
    int size_;
    std::vector<bool> taken_;
};

glm::ivec3 step_of(std::uint32_t direction) {
    glm::ivec3 step(0);
    step[direction / 2] = direction % 2 ? 1 : -1;
    return step;
}

/// A random walk over free cells, which it takes; ends where it is walled in or long enough.
std::vector<glm::ivec3> walk(Grid& grid, Random& random, double turn) {
    const auto size = static_cast<std::uint32_t>(grid.size());
    glm::ivec3 cell;
    for (int axis = 0; axis < 3; ++axis) cell[axis] = static_cast<int>(random.index(size));
    std::vector<glm::ivec3> cells;
    if (!grid.is_free(cell)) return cells;
    glm::ivec3 step = step_of(random.index(6));
    while (cells.size() < kMaxLength) {
        grid.take(cell);
        cells.push_back(cell);
        if (random.uniform() < turn) step = step_of(random.index(6));
        for (int tries = 0; tries < 6 && !grid.is_free(cell + step); ++tries)
            step = step_of(random.index(6));
        cell += step;
        if (!grid.is_free(cell)) break;
    }
    return cells;
}

/// Rings along the cells: at both ends and around the elbows; straight cells need none.
std::vector<Ring> rings_along(const std::vector<glm::ivec3>& cells, double radius,
                              std::size_t steps) {
    std::vector<Ring> rings;
    const glm::dvec3 first(cells[1] - cells[0]);
    rings.push_back({glm::dvec3(cells[0]) - 0.3 * first, first, radius});
    for (std::size_t i = 1; i + 1 < cells.size(); ++i) {
        const glm::dvec3 in(cells[i] - cells[i - 1]), out(cells[i + 1] - cells[i]);
        if (in == out) continue;
        // A quarter circle of radius 0.5 from one face's centre to the other's.
        const glm::dvec3 pivot = glm::dvec3(cells[i]) + 0.5 * (out - in);
        for (std::size_t k = 0; k <= steps; ++k) {
            const glm::dvec2 c =
                unit_circle(0.25 * static_cast<double>(k) / static_cast<double>(steps));
            const Ring ring{pivot + 0.5 * (c.y * in - c.x * out), c.x * in + c.y * out, radius};
            // Elbows in a row share a ring.
            if (k > 0 || ring.center != rings.back().center) rings.push_back(ring);
        }
    }
    const glm::dvec3 last(cells.back() - cells[cells.size() - 2]);
    rings.push_back({glm::dvec3(cells.back()) + 0.3 * last, last, radius});
    return rings;
}

GeneratedScene generate(const Settings& settings) {
    const auto triangles = static_cast<std::size_t>(settings.integer("triangles"));
    const auto sides = static_cast<std::size_t>(settings.integer("sides"));
    const double turn = settings.real("turn");
    Random random(static_cast<std::uint64_t>(settings.integer("seed")));

    // At least so many triangles come out per cell, even where half of the turns fail and elbows in
    // a row share a ring; so the share of taken cells stays below `fill`, and walks find room.
    const std::size_t steps = elbow_steps(sides);
    const double per_cell = (0.6 * turn + 0.03) * 2 * static_cast<double>(sides * steps);
    const double cells = static_cast<double>(triangles) / per_cell / settings.real("fill");
    Grid grid(static_cast<int>(std::cbrt(cells)) + 3);

    GeneratedScene scene;
    scene.mesh.triangles.reserve(triangles);
    const double center = 0.5 * (grid.size() - 1);
    while (scene.mesh.triangle_count() < triangles) {
        const std::vector<glm::ivec3> path = walk(grid, random, turn);
        if (path.size() < 2) continue;
        std::vector<Ring> rings = rings_along(path, random.uniform(0.15, 0.35), steps);
        for (Ring& ring : rings) ring.center -= center;
        add_tube(scene.mesh, rings, sides);
    }

    const float half = 0.5f * static_cast<float>(grid.size());
    scene.camera = {{1.5f * half, 1.1f * half, 2.2f * half}, {0, 0, 0}, {0, 1, 0}, 50};
    scene.light = {structures::geometry::Light::Type::point,
                   {-1.5f * half, 2.2f * half, 1.2f * half}};
    return scene;
}

}  // namespace

GeneratorRow pipes() {
    return {"pipes", "a tangle of axis-aligned pipes with elbows", &parameters, &generate};
}

}  // namespace experiments::scenes
