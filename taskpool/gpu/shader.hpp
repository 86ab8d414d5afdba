// SPIR-V embedded at build time by add_shaders().
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace taskpool::gpu {

struct Shader {
    std::string_view path;  ///< relative to the repository root, e.g. "taskpool/pool/pool.comp"
    std::span<const std::uint32_t> code;
};

/// The shader of that path; throws std::logic_error if `table` has none.
const Shader& find_shader(std::span<const Shader> table, std::string_view path);

}  // namespace taskpool::gpu
