// First include of a pool kernel, before its struct Task and struct Client.
#include "taskpool/gpu/device.glsl"
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_EXT_shader_realtime_clock : require
#include "taskpool/pool/pool_shared.h"

// Buffers that subgroups of one launch exchange data through. Only nonprivate accesses take part in
// the memory model; clients declare what several tasks touch with this.
#define pool_buffer(alignment) \
    layout(buffer_reference, scalar, buffer_reference_align = alignment) nonprivate buffer

pool_buffer(4) PoolInts { int at[]; };
pool_buffer(4) PoolUints { uint at[]; };

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kPolicy = 0;
/// Chunks a subgroup claims at least (K of the paper), and below which a step is run at once.
layout(constant_id = 2) const uint kMinChunks = 14;
/// Tasks whose first step has fewer chunks stay private to the subgroup that spawns them; 0: none do.
layout(constant_id = 3) const uint kPrivateChunks = 0;
/// Tasks a subgroup can hold privately.
layout(constant_id = 4) const uint kStackDepth = 64;
/// sizeof(PoolEntry), which GLSL cannot ask.
layout(constant_id = 5) const uint kEntryBytes = 0;
/// Loop iterations that one chunk with its transition may take, as the client promises.
layout(constant_id = 6) const uint kChunkIterations = 1;
/// Polls in vain after which a subgroup leaves the launch.
layout(constant_id = 7) const uint kIdlePolls = 1000000;
layout(constant_id = 8) const bool kTrace = false;
/// Loop iterations that a turn of the engine's loop counts for, beyond its chunk.
layout(constant_id = 9) const uint kTurnIterations = 1;
// Constants from 16 on are the client's.
