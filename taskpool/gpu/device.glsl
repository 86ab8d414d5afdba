// The language every kernel is written in: first include of each shader.
//
// Extensions, the Vulkan memory model (without the pragma, scoped atomics silently compile to the old
// model), one subgroup per workgroup (specialisation constant 0 is the subgroup size), and plain
// buffer references.
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_EXT_control_flow_attributes : require
#pragma use_vulkan_memory_model

#define scalar_buffer(alignment) layout(buffer_reference, scalar, buffer_reference_align = alignment) buffer

/// Whether a subgroup's lanes run in lockstep, as on a CPU device, where a control barrier would put
/// the whole workgroup aside; set by gpu::Kernel.
layout(constant_id = 100) const bool kLockstep = false;

/// Lanes of this subgroup see what the others wrote before, to shared memory and to buffers.
void subgroup_sync() {
    if (kLockstep)
        subgroupMemoryBarrier();
    else
        subgroupBarrier();
}

scalar_buffer(4) UintArray { uint at[]; };
scalar_buffer(4) IntArray { int at[]; };
scalar_buffer(4) FloatArray { float at[]; };
scalar_buffer(4) Vec3Array { vec3 at[]; };
scalar_buffer(4) Uvec3Array { uvec3 at[]; };
scalar_buffer(16) Uvec4Array { uvec4 at[]; };
