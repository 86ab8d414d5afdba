// Variations of a stress scene whose answers should be the same: moved and turned, with its
// triangles in another order, larger or smaller.
//
//     for (const Variation& variation : variations(config.stability, config.seed, test.most))
//         judge(vary(scene, variation));
#pragma once

#include <string>
#include <vector>

#include "experiments/config/stability.hpp"
#include "experiments/stability/scene.hpp"

namespace experiments::stability {

struct Variation {
    enum class Kind { none, transform, order, scale };
    Kind kind = Kind::none;
    std::uint64_t seed = 0;  ///< of a transform or an order
    double factor = 1;       ///< of a scale

    /// "as built", "transform 81", "order 3", "scale 0.01".
    std::string label() const;
    /// Whether coordinates stay as they were built.
    bool keeps_coordinates() const { return kind == Kind::none || kind == Kind::order; }
};

/// First the scene as it is, then at most `most` of each kind.
std::vector<Variation> variations(const config::Stability& config, std::int64_t seed, int most);

/// The scene varied. New coordinates are computed in double precision and rounded once. A transform
/// is a rotation about the origin and then a shift by up to the scene's extent. With another order,
/// points keep the triangles they lie on, by their new ids, and `essential` is dropped.
Scene vary(const Scene& scene, const Variation& variation);

}  // namespace experiments::stability
