// A hash of a tree's bytes: equal trees have equal fingerprints.
#pragma once

#include "structures/bvh/tree.hpp"
#include "structures/hash.hpp"

namespace structures::bvh {

/// FNV-1a over the words of the nodes that a walk reaches, and of the order. Holes do not count.
inline std::uint64_t fingerprint(const Tree& tree) {
    Hash hash;
    walk(tree, [&](std::uint32_t index, std::uint32_t) { hash.add(tree.nodes[index]); });
    for (const std::uint32_t id : tree.order) hash.add(id);
    return hash.value();
}

}  // namespace structures::bvh
