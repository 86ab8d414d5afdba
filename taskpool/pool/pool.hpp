// Host side of the task pool: its buffers, its launches, its growth.
//
//     Pool pool(device, find_shader(shaders, "my/client.comp"), client_spec, PoolConfig{});
//     pool.restart(Start{.phase = 0, .chunks = 100}, my_root_task);
//     do {
//         gpu::Recorder recorder(device);
//         pool.record(recorder, my_client);   // my_client: the struct Client of the kernel
//         device.run(recorder);
//     } while (pool.advance());
//     pool.status().state.chunks;             // counters
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "taskpool/gpu/recorder.hpp"
#include "taskpool/pool/pool_shared.h"

namespace taskpool::pool {

enum class Policy : std::uint32_t { scan = kPolicyScan, bitmap = kPolicyBitmap };
/// "scan" or "bitmap"; throws std::invalid_argument for anything else.
Policy policy_from(std::string_view name);

struct PoolConfig {
    Policy policy = Policy::bitmap;
    std::uint32_t slots = 4096;  ///< to begin with, rounded up to a multiple of 64; grows as needed
    std::uint32_t subgroups = 0;   ///< workgroups per launch; 0: as many as the device keeps busy
    std::uint32_t min_chunks = 2;  ///< K: claimed at least; steps with fewer are run at once
    /// Tasks that start with fewer chunks stay with the subgroup that spawned them (policy bitmap).
    std::uint32_t private_chunks = 4;
    /// Loop iterations and time after which a subgroup leaves a launch. A driver that cuts loops
    /// (DeviceInfo::loop_limit) bounds the former further.
    std::uint32_t iteration_budget = 1u << 30;
    std::uint32_t time_budget_ms = 500;  ///< at most 4000
    std::uint32_t trace_capacity = 0;    ///< records kept of single chunks; 0: no tracing
};

/// What the pool must know about a client kernel.
struct ClientSpec {
    std::uint32_t task_bytes = 0;  ///< sizeof(Task): 32-bit members only
    /// Loop iterations that one chunk and its transition may take.
    std::uint32_t chunk_iterations = 1;
    std::vector<gpu::Constant> constants{};  ///< ids from 16 on
    /// Loops in the text of the hooks, at most. Mesa before version 23 runs a branch that no lane
    /// takes with all lanes off: each of its loops still counts one iteration.
    std::uint32_t loops = 16;
};

/// Loop iterations that a turn of a loop whose text holds `loops` loops, the engine's beside them,
/// is charged (kTurnIterations there): 1 on drivers that do not cut loops.
std::uint32_t turn_iterations(const gpu::Device& device, std::uint32_t loops);

/// First step of the root task.
struct RootStart {
    std::uint32_t phase = 0, step = 0, chunks = 0;
};

struct PoolStatus {
    PoolState state{};
    std::uint32_t capacity = 0;  ///< slots now
    std::uint32_t launches = 0;
    std::uint32_t growths = 0;  ///< times the number of slots was doubled
    bool output_full = false;   ///< a task waits for the client to enlarge its output
};

class Pool {
  public:
    Pool(gpu::Device& device, const gpu::Shader& kernel, ClientSpec client, PoolConfig config);

    /// Bytes of device memory of a pool with this configuration, before any growth.
    static std::size_t required_bytes(const gpu::Device& device, const ClientSpec& client,
                                      const PoolConfig& config);

    /// Empties the pool and puts one task into it.
    template <typename Task>
    void restart(const RootStart& start, const Task& root) {
        static_assert(std::is_trivially_copyable_v<Task> && alignof(Task) <= 4);
        restart_with(start, &root, sizeof(Task));
    }

    /// Records the next launch, barriers included.
    template <typename Client>
    void record(gpu::Recorder& recorder, const Client& client) {
        struct {
            PoolPush pool;
            Client client;
        } push{next_push(), client};
        static_assert(sizeof(push) == sizeof(PoolPush) + sizeof(Client));
        recorder.dispatch(kernel_, push, subgroups_);
        recorder.barrier();
    }

    /// To be called when the launch is done: reads its counters, doubles the slots if a spawn found
    /// none. True if tasks are left. Throws gpu::Error if launches stop making progress, or if the
    /// driver cut their loops: the client counts too few iterations.
    bool advance();

    const PoolStatus& status() const { return status_; }
    std::uint32_t subgroups() const { return subgroups_; }
    /// What was traced so far, oldest first, and how many records found no room.
    std::vector<TraceRecord> read_trace(std::uint32_t& dropped) const;

  private:
    void restart_with(const RootStart& start, const void* root, std::size_t bytes);
    PoolPush next_push() const;
    void allocate(std::uint32_t capacity);
    void grow();
    void write_maps(std::span<const std::int32_t> headers);

    gpu::Device* device_;
    ClientSpec client_;
    PoolConfig config_;
    std::uint32_t subgroups_;
    gpu::Kernel kernel_;
    gpu::Buffer headers_, infos_, tasks_, unfinished_, maps_, stacks_, state_, trace_;
    PoolStatus status_;
    std::uint32_t idle_launches_ = 0;
};

/// Chrome/Perfetto trace-event JSON of `records`: one row per subgroup, one box per chunk, named
/// after its phase (`phase_names[phase]`, or "phase N").
std::string chrome_trace(std::span<const TraceRecord> records,
                         std::span<const std::string> phase_names);

}  // namespace taskpool::pool
