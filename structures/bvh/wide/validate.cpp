// Checks a wide BVH read back from the device.
#include <fmt/format.h>

#include "structures/bvh/wide/wide.hpp"

namespace structures::bvh::wide {
namespace {

struct Walk {
    const WideHeader& header;
    const std::vector<WideChild>& nodes;
    const std::vector<geometry::CornerTriangle>& triangles;
    std::vector<std::string> violations;
    std::vector<std::uint32_t> node_visits, triangle_visits;

    template <typename... Arguments>
    void report(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
        if (violations.size() < 20)
            violations.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
    }

    /// Bounds in double precision: exact for grid bounds.
    struct Box {
        glm::dvec3 lower, upper;
    };
    Box box(const WideChild& child) const {
        const glm::dvec3 low(child.x & 0xffff, child.y & 0xffff, child.z & 0xffff);
        const glm::dvec3 high(child.x >> 16, child.y >> 16, child.z >> 16);
        const glm::dvec3 origin(header.origin), cell(header.cell);
        return {origin + cell * low, origin + cell * high};
    }

    void leaf(std::uint32_t node, const WideChild& child) {
        const std::uint32_t first = child.link & kLeafFirstMask;
        const std::uint32_t count = (child.link & ~kLeafBit) >> kLeafCountShift;
        if (count == 0 || first + std::uint64_t(count) > triangles.size())
            return report("node {}: leaf of {} triangles from {}, out of range", node, count,
                          first);
        const Box bounds = box(child);
        for (std::uint32_t t = first; t < first + count; ++t) {
            ++triangle_visits[t];
            for (const glm::vec3& corner : {triangles[t].a, triangles[t].b, triangles[t].c})
                if (!glm::all(glm::lessThanEqual(bounds.lower, glm::dvec3(corner))) ||
                    !glm::all(glm::greaterThanEqual(bounds.upper, glm::dvec3(corner))))
                    report("node {}: triangle {} sticks out of its leaf's box", node, t);
        }
    }

    void run() {
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const std::uint32_t node = stack.back();
            stack.pop_back();
            if (node_visits[node]++ > 0) {
                report("node {}: reached twice", node);
                continue;
            }
            bool seen_leaf = false, seen_empty = false;
            for (std::uint32_t slot = 0; slot < kWidth; ++slot) {
                const WideChild& child = nodes[std::size_t(node) * kWidth + slot];
                if (child.link == kEmptyLink) {
                    seen_empty = true;
                } else if (child.link & kLeafBit) {
                    if (seen_empty) report("node {}: leaf after an empty slot", node);
                    seen_leaf = true;
                    leaf(node, child);
                } else {
                    if (seen_leaf || seen_empty) report("node {}: inner child not first", node);
                    const std::uint32_t base = nodes[std::size_t(node) * kWidth].link;
                    if (child.link != base + slot || child.link >= header.node_count)
                        report("node {}: slot {} links to {}, first child is {} of {}", node, slot,
                               child.link, base, header.node_count);
                    else
                        stack.push_back(child.link);
                }
            }
        }
    }

    /// Union of the leaf triangles under each child must lie in the child's box: bottom-up, as
    /// children have larger indices than their parents.
    void check_boxes() {
        std::vector<geometry::Aabb> content(header.node_count);
        for (std::uint32_t node = header.node_count; node-- > 0;)
            for (std::uint32_t slot = 0; slot < kWidth; ++slot) {
                const WideChild& child = nodes[std::size_t(node) * kWidth + slot];
                if (child.link == kEmptyLink) continue;
                geometry::Aabb inside;
                if (child.link & kLeafBit) {
                    const std::uint32_t first = child.link & kLeafFirstMask;
                    const std::uint32_t count = (child.link & ~kLeafBit) >> kLeafCountShift;
                    for (std::uint32_t t = first; t < first + count; ++t)
                        for (const glm::vec3& p : {triangles[t].a, triangles[t].b, triangles[t].c})
                            inside.grow(p);
                } else {
                    if (child.link <= node) {
                        report("node {}: child {} is not behind its parent", node, child.link);
                        continue;
                    }
                    inside = content[child.link];
                    const Box bounds = box(child);
                    if (!glm::all(glm::lessThanEqual(bounds.lower, glm::dvec3(inside.lower))) ||
                        !glm::all(glm::greaterThanEqual(bounds.upper, glm::dvec3(inside.upper))))
                        report("node {}: child {} sticks out of its box", node, child.link);
                }
                content[node].grow(inside);
            }
    }
};

}  // namespace

std::vector<std::string> validate(const WideHeader& header, const std::vector<WideChild>& nodes,
                                  const std::vector<geometry::CornerTriangle>& triangles,
                                  const std::vector<std::uint32_t>& order,
                                  const geometry::TriangleMesh& mesh) {
    Walk walk{header, nodes, triangles, {}, {}, {}};
    if (header.pending > 0) walk.report("{} nodes are still pending", header.pending);
    if (triangles.size() != order.size())
        walk.report("{} triangles for a leaf order of {}", triangles.size(), order.size());
    for (std::size_t i = 0; i < std::min(triangles.size(), order.size()); ++i) {
        const geometry::CornerTriangle& t = triangles[i];
        if (t.primitive != order[i] || t.a != mesh.corner(order[i], 0) ||
            t.b != mesh.corner(order[i], 1) || t.c != mesh.corner(order[i], 2))
            walk.report("triangle {} is not primitive {}", i, order[i]);
    }
    if (!walk.violations.empty()) return walk.violations;
    walk.node_visits.resize(header.node_count);
    walk.triangle_visits.resize(triangles.size());
    if (header.node_count > 0) walk.run();
    for (std::size_t node = 0; node < walk.node_visits.size(); ++node)
        if (walk.node_visits[node] == 0) walk.report("node {}: not reached", node);
    for (std::size_t t = 0; t < walk.triangle_visits.size(); ++t)
        if (walk.triangle_visits[t] != 1)
            walk.report("triangle {}: in {} leaves", t, walk.triangle_visits[t]);
    if (walk.violations.empty()) walk.check_boxes();
    return walk.violations;
}

}  // namespace structures::bvh::wide
