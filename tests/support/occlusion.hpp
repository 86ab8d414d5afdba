// The occlusion test on the host: the shader's filter in the same arithmetic, and the exact answer,
// triangle by triangle.
#pragma once

#include <cstdint>

#include "structures/geometry/light.hpp"
#include "structures/geometry/triangle_mesh.hpp"

namespace tests {

enum class Decision { no, yes, unsure };
/// The part of shadows/occlusion.glsl in single precision, operation for operation.
Decision occludes_filtered(glm::vec3 p, const structures::geometry::Light& light, glm::vec3 a,
                           glm::vec3 b, glm::vec3 c);

/// What shadows/occlusion.glsl promises: by the judge's exact signs, without its tree.
bool occludes_exactly(glm::vec3 p, const structures::geometry::Light& light, glm::vec3 a,
                      glm::vec3 b, glm::vec3 c);

/// Whether any triangle but `own` blocks p's segment, exactly; those that are degenerate do not.
bool occluded(glm::vec3 p, std::uint32_t own, const structures::geometry::Light& light,
              const structures::geometry::TriangleMesh& mesh);

}  // namespace tests
