// Lets one header be compiled by C++ and GLSL: in C++ it names the GLSL types, in GLSL it is empty.
// A shared header includes this, uses scalar layout, and is read in GLSL after taskpool/gpu/device.glsl.
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace taskpool::gpu::shared_types {
using uint = std::uint32_t;
using std::uint64_t;
using glm::dvec3;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace taskpool::gpu::shared_types
#endif
