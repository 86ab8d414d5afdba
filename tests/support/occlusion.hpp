// The occlusion test on the host: the shader's filter in the same arithmetic, the truth in numbers
// that do not round, and an independent test in double precision that says where it is sure.
#pragma once

#include <cstdint>

#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

enum class Decision { no, yes, unsure };
/// The part of shadows/occlusion.glsl in single precision, operation for operation.
Decision occludes_filtered(glm::vec3 p, const structures::geometry::Light& light, glm::vec3 a,
                           glm::vec3 b, glm::vec3 c);

/// What shadows/occlusion.glsl promises: signs that double precision does not vouch for are taken in
/// numbers of 1024 bits, which hold every intermediate result for floats of any size.
bool occludes_exactly(glm::vec3 p, const structures::geometry::Light& light, glm::vec3 a,
                      glm::vec3 b, glm::vec3 c);

/// The filter's answer, and the exact one where it is unsure.
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
