// A hash of a tree's bytes: equal trees have equal fingerprints.
#pragma once

#include <bit>
#include <cstdint>

#include "structures/bvh/tree.hpp"

namespace structures::bvh {

/// FNV-1a over the words of the nodes that a walk reaches, and of the order. Holes do not count.
inline std::uint64_t fingerprint(const Tree& tree) {
    std::uint64_t hash = 14695981039346656037ull;
    const auto add = [&](std::uint32_t word) { hash = (hash ^ word) * 1099511628211ull; };
    const auto add_corner = [&](glm::vec3 v) {
        for (int i = 0; i < 3; ++i) add(std::bit_cast<std::uint32_t>(v[i]));
    };
    walk(tree, [&](std::uint32_t index, std::uint32_t) {
        const BvhNode& node = tree.nodes[index];
        add_corner(node.lower);
        add(node.first);
        add_corner(node.upper);
        add(node.count);
    });
    for (const std::uint32_t id : tree.order) add(id);
    return hash;
}

}  // namespace structures::bvh
