// Variations of a stress scene whose answers should be the same: moved and turned, with its
// triangles in another order, larger or smaller.
//
//     for (const Variation& variation : variations(selection, seed, test.most))
//         const JudgedScene judged = judge(vary(scene, variation));
#pragma once

#include <string>
#include <vector>

#include "experiments/stability/scene.hpp"

namespace experiments::stability {

/// What an experiment takes of the suite.
struct Selection {
    std::vector<int> tests{};  ///< numbers, ascending
    int transforms = 10;       ///< random rigid transforms of each scene
    int orders = 10;           ///< random orders of its triangles
    std::vector<double> scales{1e-4, 1e-2, 1e2, 1e4};
};

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
std::vector<Variation> variations(const Selection& selection, std::int64_t seed, int most);

/// The scene varied. New coordinates are computed in double precision and rounded once. A transform
/// is a rotation about the origin and then a shift by up to the scene's extent. With another order,
/// points keep the triangles they lie on, by their new ids, and `essential` is dropped. With new
/// coordinates it is no longer `as_built`.
Scene vary(const Scene& scene, const Variation& variation);

}  // namespace experiments::stability
