// Host mirrors of the exact occlusion test: the same arithmetic as shadows/occlusion.glsl, and an
// independent one in double precision that says where it is sure.
#pragma once

#include <cstdint>
#include <vector>

#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

/// shadows/occlusion.glsl, operation for operation.
bool occludes(glm::vec3 p, const structures::geometry::Light& light, glm::vec3 a, glm::vec3 b,
              glm::vec3 c);

/// Whether any triangle but `own` blocks p's segment, by occludes().
bool occluded(glm::vec3 p, std::uint32_t own, const structures::geometry::Light& light,
              const structures::geometry::TriangleMesh& mesh);

enum class Answer { no, yes, unsure };
/// The same question by signed volumes in double precision; `unsure` if one of them is within the
/// rounding of single precision input of 0.
Answer occluded_double(glm::vec3 p, std::uint32_t own, const structures::geometry::Light& light,
                       const structures::geometry::TriangleMesh& mesh);

}  // namespace tests
