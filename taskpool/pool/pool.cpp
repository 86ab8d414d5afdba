#include "taskpool/pool/pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace taskpool::pool {
namespace {

constexpr std::uint32_t kStackDepth = 64;
constexpr std::uint32_t kMaxTimeBudget = 4000;  // ms: the kernel's clock wraps after 4.29 s
constexpr std::uint32_t kIdlePolls = 20000;
/// Loops in the engine once its functions are inlined: see ClientSpec::loops.
constexpr std::uint32_t kEngineLoops = 16;
/// Launches in a row that may do nothing before the pool gives up: several are normal when the
/// budget is tiny.
constexpr std::uint32_t kMaxIdleLaunches = 1000;

std::uint32_t entry_bytes(const ClientSpec& client) {
    return std::uint32_t(sizeof(TaskInfo)) + client.task_bytes;
}

std::uint32_t subgroup_count(const gpu::Device& device, const PoolConfig& config) {
    return config.subgroups ? config.subgroups : device.info().persistent_workgroups;
}

std::uint32_t iteration_budget(const gpu::Device& device, const PoolConfig& config) {
    const std::uint32_t limit = device.info().loop_limit;
    if (limit == 0) return config.iteration_budget;
    // What one turn of the engine's loop may take beyond its chunk, and what leaving takes.
    const std::uint32_t margin = 2 * kMaxLooks + 4 * kPhaseCounters;
    return std::min(config.iteration_budget, limit - margin);
}

std::size_t stack_bytes(std::uint32_t subgroups, const ClientSpec& client) {
    return (subgroups * 4 + 15) / 16 * 16 +
           std::size_t{subgroups} * kStackDepth * entry_bytes(client);
}

struct MapLayout {
    explicit MapLayout(std::uint32_t capacity)
        : words((capacity + 31) / 32), top_words((words + 31) / 32) {}
    std::uint32_t words, top_words;
    std::uint32_t total() const { return kMapCount * (words + top_words); }
    std::uint32_t top(std::uint32_t map) const { return map * (words + top_words); }
    std::uint32_t bottom(std::uint32_t map) const { return top(map) + top_words; }
};

std::uint32_t rounded_slots(std::uint32_t slots) { return std::max(64u, (slots + 63) / 64 * 64); }

gpu::Kernel make_kernel(gpu::Device& device, const gpu::Shader& shader, const ClientSpec& client,
                        const PoolConfig& config) {
    const bool is_private = config.policy != Policy::scan;
    std::vector<gpu::Constant> constants{
        {1, std::uint32_t(config.policy)},
        {2, std::max(config.min_chunks, 1u)},
        {3, is_private ? config.private_chunks : 0u},
        {4, kStackDepth},
        {5, entry_bytes(client)},
        {6, client.chunk_iterations},
        {7, std::min(kIdlePolls, iteration_budget(device, config) / 2)},
        {8, config.trace_capacity > 0},
        {9, turn_iterations(device, client.loops)},
    };
    constants.insert(constants.end(), client.constants.begin(), client.constants.end());
    return gpu::Kernel(device, shader, constants);
}

}  // namespace

std::uint32_t turn_iterations(const gpu::Device& device, std::uint32_t loops) {
    return device.info().loop_limit > 0 ? kEngineLoops + loops : 1;
}

Policy policy_from(std::string_view name) {
    if (name == "scan") return Policy::scan;
    if (name == "bitmap") return Policy::bitmap;
    throw std::invalid_argument(
        fmt::format("no scheduling policy '{}'; there are 'scan' and 'bitmap'", name));
}

Pool::Pool(gpu::Device& device, const gpu::Shader& kernel, ClientSpec client, PoolConfig config)
    : device_(&device),
      client_(std::move(client)),
      config_(config),
      subgroups_(subgroup_count(device, config)),
      kernel_(make_kernel(device, kernel, client_, config)),
      stacks_(device, stack_bytes(subgroups_, client_), "pool stacks"),
      state_(device, sizeof(PoolState), "pool state"),
      trace_(device, std::size_t{config.trace_capacity} * sizeof(TraceRecord), "pool trace") {
    if (iteration_budget(device, config) < 4 * client_.chunk_iterations)
        throw std::invalid_argument(fmt::format(
            "iteration budget {} is below four chunks of {} iterations: no launch would progress",
            iteration_budget(device, config), client_.chunk_iterations));
    allocate(rounded_slots(config.slots));
}

std::size_t Pool::required_bytes(const gpu::Device& device, const ClientSpec& client,
                                 const PoolConfig& config) {
    const std::uint32_t slots = rounded_slots(config.slots);
    return slots * (2 * sizeof(std::int32_t) + entry_bytes(client)) + MapLayout(slots).total() * 4 +
           stack_bytes(subgroup_count(device, config), client) + sizeof(PoolState) +
           std::size_t{config.trace_capacity} * sizeof(TraceRecord);
}

void Pool::allocate(std::uint32_t capacity) {
    status_.capacity = capacity;
    headers_ = gpu::Buffer(*device_, capacity * sizeof(std::int32_t), "pool headers");
    infos_ = gpu::Buffer(*device_, capacity * sizeof(TaskInfo), "pool infos");
    tasks_ = gpu::Buffer(*device_, std::size_t{capacity} * client_.task_bytes, "pool tasks");
    unfinished_ = gpu::Buffer(*device_, capacity * sizeof(std::int32_t), "pool unfinished");
    maps_ = gpu::Buffer(*device_, MapLayout(capacity).total() * 4, "pool maps");
}

void Pool::write_maps(std::span<const std::int32_t> headers) {
    const MapLayout layout(status_.capacity);
    std::vector<std::uint32_t> words(layout.total(), 0);
    const auto set = [&](std::uint32_t map, std::uint32_t slot) {
        words[layout.bottom(map) + slot / 32] |= 1u << (slot % 32);
        words[layout.top(map) + slot / 1024] |= 1u << (slot / 32 % 32);
    };
    for (std::uint32_t slot = 0; slot < headers.size(); ++slot) {
        if (headers[slot] > 0) set(kActiveMap, slot);
        if (headers[slot] == kEmpty) set(kEmptyMap, slot);
    }
    maps_.write(words.data(), words.size() * 4);
}

void Pool::restart_with(const RootStart& start, const void* root, std::size_t bytes) {
    if (bytes != client_.task_bytes) throw std::logic_error("root task of another type");
    const std::int32_t chunks = std::max(std::int32_t(start.chunks), 1);
    std::vector<std::int32_t> headers(status_.capacity, kEmpty);
    headers[0] = chunks;
    headers_.write(headers.data(), headers.size() * sizeof(std::int32_t));
    write_maps(headers);
    const TaskInfo info{kStateRun, start.phase, start.step, start.chunks, 0, kNoSlot, 0, 0, 0, 0};
    infos_.write(&info, sizeof(info));
    tasks_.write(root, bytes);
    unfinished_.write(&chunks, sizeof(chunks));
    const std::vector<std::uint32_t> empty_stacks(subgroups_, 0);
    stacks_.write(empty_stacks.data(), empty_stacks.size() * 4);
    PoolState state{};
    state.live = state.peak_live = 1;
    state.high_water = 1;
    state_.write(&state, sizeof(state));
    status_ = PoolStatus{state, status_.capacity};
    idle_launches_ = 0;
}

PoolPush Pool::next_push() const {
    return {headers_.address(),
            infos_.address(),
            tasks_.address(),
            unfinished_.address(),
            maps_.address(),
            stacks_.address(),
            state_.address(),
            trace_.address(),
            status_.capacity,
            iteration_budget(*device_, config_),
            std::min(config_.time_budget_ms, kMaxTimeBudget) * 1000,
            config_.trace_capacity};
}

bool Pool::advance() {
    const PoolState before = status_.state;
    state_.read(&status_.state, sizeof(PoolState));
    PoolState& state = status_.state;
    ++status_.launches;
    if (state.cut > 0)
        throw gpu::Error(
            VK_ERROR_UNKNOWN,
            fmt::format("the driver cut the loops of a task pool's kernel, which took more than {} "
                        "iterations: the client tells pool_spend() of too few",
                        device_->info().loop_limit));
    if (state.live == 0) return false;

    const bool idle = state.chunks == before.chunks && state.spawned == before.spawned &&
                      state.live == before.live;
    idle_launches_ = idle ? idle_launches_ + 1 : 0;
    if (idle_launches_ > kMaxIdleLaunches)
        throw gpu::Error(
            VK_NOT_READY,
            fmt::format("the task pool made no progress in {} launches ({} tasks live, "
                        "{} slots): a client that waits for a task that never ends?",
                        kMaxIdleLaunches, state.live, status_.capacity));
    status_.output_full = state.blocked > 0;
    if (state.stalled > 0) grow();
    state.stalled = state.blocked = 0;
    state_.write(&state, sizeof(PoolState));
    return true;
}

void Pool::grow() {
    const std::uint32_t old = status_.capacity;
    auto headers = gpu::read<std::int32_t>(headers_, old);
    // Slots may have become free since, or lie where a search of bounded length did not get to.
    if (std::size_t(std::count(headers.begin(), headers.end(), kEmpty)) > old / 2) return;
    const auto infos = gpu::read<TaskInfo>(infos_, old);
    const auto tasks = gpu::read<std::byte>(tasks_, std::size_t{old} * client_.task_bytes);
    const auto unfinished = gpu::read<std::int32_t>(unfinished_, old);
    allocate(2 * old);
    headers.resize(2 * old, kEmpty);
    headers_.write(headers.data(), headers.size() * sizeof(std::int32_t));
    infos_.write(infos.data(), infos.size() * sizeof(TaskInfo));
    tasks_.write(tasks.data(), tasks.size());
    unfinished_.write(unfinished.data(), unfinished.size() * sizeof(std::int32_t));
    write_maps(headers);
    ++status_.growths;
}

std::vector<TraceRecord> Pool::read_trace(std::uint32_t& dropped) const {
    const std::uint32_t wanted = status_.state.trace_count;
    const std::uint32_t kept = std::min(wanted, config_.trace_capacity);
    dropped = wanted - kept;
    return gpu::read<TraceRecord>(trace_, kept);
}

}  // namespace taskpool::pool
