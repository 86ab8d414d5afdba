// The task pool under three clients that know nothing of trees, with pools from 64 slots up, 1 to
// 64 workgroups, and budgets so small that every launch does next to nothing.
#include "taskpool/pool/pool.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "tests/support/gpu_fixture.hpp"

std::span<const taskpool::gpu::Shader> tests_taskpool_pool_shaders();

namespace {

using namespace taskpool;
using namespace taskpool::pool;

struct Shape {
    Policy policy;
    std::uint32_t slots, subgroups, budget;
};

std::string shape_name(const testing::TestParamInfo<Shape>& info) {
    const Shape& s = info.param;
    return (s.policy == Policy::scan ? "scan_" : "bitmap_") + std::to_string(s.slots) + "slots_" +
           std::to_string(s.subgroups) + "groups_" + std::to_string(s.budget);
}

constexpr std::uint32_t kNoBudget = 1u << 30;

class PoolClients : public testing::WithParamInterface<Shape>, public tests::GpuTest {
  protected:
    static PoolConfig config() {
        PoolConfig config;
        config.policy = GetParam().policy;
        config.slots = GetParam().slots;
        config.subgroups = GetParam().subgroups;
        config.iteration_budget = GetParam().budget;
        return config;
    }
    static const gpu::Shader& shader(const std::string& name) {
        return gpu::find_shader(tests_taskpool_pool_shaders(), "tests/taskpool/clients/" + name);
    }
    template <typename Client>
    static bool launch(Pool& pool, const Client& client) {
        gpu::Recorder recorder(tests::device());
        pool.record(recorder, client);
        tests::device().run(recorder);
        return pool.advance();
    }
    /// What holds after any complete run.
    static void expect_complete(const Pool& pool) {
        const PoolState& state = pool.status().state;
        EXPECT_EQ(state.live, 0);
        EXPECT_GE(state.peak_live, 1);
        EXPECT_LE(state.high_water, pool.status().capacity);
        EXPECT_EQ(std::accumulate(std::begin(state.phase_chunks), std::end(state.phase_chunks), 0u),
                  state.chunks);
    }
};

std::vector<std::uint32_t> random_keys(std::size_t count, std::uint32_t range, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> keys(count);
    for (std::uint32_t& key : keys) key = random() % range;
    return keys;
}

struct SortTask {
    std::uint32_t first, count, low, high, side, below;
};
struct SortClient {
    std::uint64_t keys[2], cursors, leaves;
    std::uint32_t leaf_capacity, padding = 0;
};

/// Sorts on the pool; the list of leaves starts with room for `leaf_capacity`.
std::vector<std::uint32_t> pool_sort(Pool& pool, const std::vector<std::uint32_t>& keys,
                                     std::uint32_t range, std::uint32_t leaf_capacity) {
    gpu::Device& device = tests::device();
    const auto count = std::uint32_t(keys.size());
    const gpu::Buffer a = gpu::make_buffer<std::uint32_t>(device, keys, "keys");
    const gpu::Buffer b(device, keys.size() * 4, "other keys");
    const gpu::Buffer cursors = gpu::make_buffer<std::uint32_t>(
        device, std::vector<std::uint32_t>(count + 2, 0), "cursors");
    gpu::Buffer leaves = gpu::make_buffer<std::uint32_t>(
        device, std::vector<std::uint32_t>(leaf_capacity + 1, 0), "leaves");
    const std::uint32_t chunks = count <= 8 ? 0 : (count + 255) / 256;
    pool.restart(RootStart{0, 0, chunks}, SortTask{0, count, 0, range - 1, 0, 0});
    for (bool more = true; more;) {
        gpu::Recorder recorder(device);
        pool.record(
            recorder,
            SortClient{
                {a.address(), b.address()}, cursors.address(), leaves.address(), leaf_capacity});
        device.run(recorder);
        more = pool.advance();
        if (pool.status().output_full) {
            auto list = gpu::read<std::uint32_t>(leaves, leaf_capacity + 1);
            leaf_capacity *= 2;
            list.resize(leaf_capacity + 1);
            leaves = gpu::make_buffer<std::uint32_t>(device, list, "leaves");
        }
    }
    EXPECT_EQ(pool.status().state.progress, count);
    const auto listed = gpu::read<std::uint32_t>(leaves, 1)[0];
    EXPECT_LE(listed, leaf_capacity);
    auto firsts = gpu::read<std::uint32_t>(leaves, listed, 1);
    EXPECT_TRUE(std::find(firsts.begin(), firsts.end(), 0u) != firsts.end());
    return gpu::read<std::uint32_t>(a, count);
}

ClientSpec sort_spec() { return {sizeof(SortTask), 300}; }

TEST_P(PoolClients, SortsKeys) {
    const bool tiny = GetParam().budget != kNoBudget;
    const std::uint32_t sizes[] = {0, 1, 2, 8, 9, 255, 256, 257, 5000, tiny ? 50'000u : 1'000'000u};
    Pool pool(tests::device(), shader("sort.comp"), sort_spec(), config());
    for (const std::uint32_t count : sizes) {
        auto keys = random_keys(count, 1u << 31, 17 + count);
        const auto sorted = pool_sort(pool, keys, 1u << 31, 100);
        std::sort(keys.begin(), keys.end());
        ASSERT_EQ(sorted, keys) << count << " keys";
        if (count == sizes[9]) {
            expect_complete(pool);
            // A budget of so few iterations is spent hundreds of times.
            if (tiny) {
                EXPECT_GT(pool.status().launches * GetParam().subgroups, 200u);
            }
        }
    }
}

TEST_P(PoolClients, SortsDuplicates) {
    Pool pool(tests::device(), shader("sort.comp"), sort_spec(), config());
    for (const std::uint32_t range : {1u, 2u, 5u}) {
        auto keys = random_keys(20'000, range, range);
        const auto sorted = pool_sort(pool, keys, range, 4);
        std::sort(keys.begin(), keys.end());
        ASSERT_EQ(sorted, keys) << "keys below " << range;
    }
}

TEST_P(PoolClients, ReducesByForkAndJoin) {
    struct Task {
        std::uint32_t first, count;
    };
    struct Client {
        std::uint64_t values;
    };
    gpu::Device& device = tests::device();
    Pool pool(device, shader("reduce.comp"), {sizeof(Task), 40}, config());
    const bool tiny = GetParam().budget != kNoBudget;
    for (const std::uint32_t count : {1u, 2u, 1023u, 1024u, 1025u, tiny ? 60'000u : 1'000'000u}) {
        const auto values = random_keys(count, 1000, count);
        const gpu::Buffer buffer = gpu::make_buffer<std::uint32_t>(device, values, "values");
        pool.restart(RootStart{}, Task{0, count});
        while (launch(pool, Client{buffer.address()})) {
        }
        EXPECT_EQ(gpu::read<std::uint32_t>(buffer, 1)[0],
                  std::accumulate(values.begin(), values.end(), 0u))
            << count << " values";
    }
    expect_complete(pool);
}

TEST_P(PoolClients, RespectsDependencies) {
    struct Task {
        std::uint32_t node;
    };
    struct Client {
        std::uint64_t first_successor, successors, predecessor_count, slot_of, finished;
        std::uint32_t node_count, padding = 0;
    };
    const std::uint32_t nodes = GetParam().budget != kNoBudget ? 5'000 : 100'000;
    std::mt19937 random(3);
    std::vector<std::vector<std::uint32_t>> successors(nodes);
    std::vector<std::uint32_t> predecessor_count(nodes, 0);
    for (std::uint32_t v = 1; v < nodes; ++v) {
        const std::uint32_t reach = random() % 2 ? v : std::min(v, 20u);
        for (std::uint32_t k = random() % 4; k > 0; --k) {
            successors[v - 1 - random() % reach].push_back(v);
            ++predecessor_count[v];
        }
    }
    std::vector<std::uint32_t> first(1, 0), flat;
    for (const auto& list : successors) {
        flat.insert(flat.end(), list.begin(), list.end());
        first.push_back(std::uint32_t(flat.size()));
    }
    gpu::Device& device = tests::device();
    const gpu::Buffer firsts = gpu::make_buffer<std::uint32_t>(device, first, "firsts");
    const gpu::Buffer edges = gpu::make_buffer<std::uint32_t>(device, flat, "edges");
    const gpu::Buffer counts = gpu::make_buffer<std::uint32_t>(device, predecessor_count, "counts");
    const gpu::Buffer slots(device, nodes * 4, "slots");
    const gpu::Buffer finished = gpu::make_buffer<std::uint32_t>(
        device, std::vector<std::uint32_t>(nodes + 1, 0), "finished");
    Pool pool(device, shader("graph.comp"), {sizeof(Task), 100}, config());
    pool.restart(RootStart{}, Task{0xffffffffu});
    while (launch(pool, Client{firsts.address(), edges.address(), counts.address(), slots.address(),
                               finished.address(), nodes})) {
    }
    expect_complete(pool);
    EXPECT_EQ(pool.status().state.spawned, nodes);
    const auto order = gpu::read<std::uint32_t>(finished, nodes, 1);
    for (std::uint32_t u = 0; u < nodes; ++u) {
        ASSERT_GT(order[u], 0u) << "node " << u << " never ran";
        for (const std::uint32_t v : successors[u]) ASSERT_LT(order[u], order[v]);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, PoolClients,
    testing::Values(Shape{Policy::scan, 64, 1, kNoBudget}, Shape{Policy::scan, 4096, 2, kNoBudget},
                    Shape{Policy::scan, 1024, 64, kNoBudget}, Shape{Policy::scan, 64, 3, 1500},
                    Shape{Policy::bitmap, 64, 1, kNoBudget},
                    Shape{Policy::bitmap, 64, 2, kNoBudget},
                    Shape{Policy::bitmap, 65536, 2, kNoBudget},
                    Shape{Policy::bitmap, 4096, 64, kNoBudget}, Shape{Policy::bitmap, 64, 3, 1500},
                    Shape{Policy::bitmap, 2048, 64, 1300}),
    shape_name);

class PoolSettings : public tests::GpuTest {};

TEST_F(PoolSettings, BadOnesAreRefused) {
    EXPECT_THROW(policy_from("fifo"), std::invalid_argument);
    EXPECT_EQ(policy_from("scan"), Policy::scan);
    PoolConfig config;
    config.iteration_budget = 100;
    const auto& shader =
        gpu::find_shader(tests_taskpool_pool_shaders(), "tests/taskpool/clients/sort.comp");
    EXPECT_THROW(Pool(tests::device(), shader, sort_spec(), config), std::invalid_argument);
}

TEST_F(PoolSettings, IterationsThatAClientDoesNotCountAreNotLostInSilence) {
    struct Task {
        std::uint32_t iterations;
    };
    struct Client {
        std::uint64_t counted;
    };
    gpu::Device& device = tests::device();
    const auto& shader =
        gpu::find_shader(tests_taskpool_pool_shaders(), "tests/taskpool/clients/uncounted.comp");
    Pool pool(device, shader, {sizeof(Task), 1}, {.subgroups = 1});
    const gpu::Buffer counted(device, 8, "counted");
    const auto run = [&](std::uint32_t iterations) {
        pool.restart(RootStart{0, 0, 1}, Task{iterations});
        gpu::Recorder recorder(device);
        pool.record(recorder, Client{counted.address()});
        device.run(recorder);
        EXPECT_FALSE(pool.advance());
        return gpu::read<std::uint32_t>(counted, 1)[0];
    };
    const std::uint32_t limit = device.info().loop_limit;
    for (const std::uint32_t iterations : {1000u, 60'000u}) EXPECT_EQ(run(iterations), iterations);
    if (limit > 0) {
        EXPECT_THROW(run(limit), gpu::Error);
    } else {
        EXPECT_EQ(run(100'000), 100'000u);
    }
}

TEST_F(PoolSettings, TracesChunksAsChromeEvents) {
    PoolConfig config;
    config.trace_capacity = 1000;
    const auto& shader =
        gpu::find_shader(tests_taskpool_pool_shaders(), "tests/taskpool/clients/sort.comp");
    Pool pool(tests::device(), shader, sort_spec(), config);
    pool_sort(pool, random_keys(100'000, 1000, 1), 1000, 100'000);
    std::uint32_t dropped = 0;
    const auto records = pool.read_trace(dropped);
    EXPECT_EQ(records.size(), 1000u);
    EXPECT_EQ(dropped + 1000, pool.status().state.chunks);
    const std::string names[] = {"partition", "leaf"};
    const auto json = nlohmann::json::parse(chrome_trace(records, names));
    ASSERT_EQ(json["traceEvents"].size(), 1000u);
    for (const auto& event : json["traceEvents"]) {
        EXPECT_THAT(event["name"].get<std::string>(), testing::AnyOf("partition", "leaf"));
        EXPECT_GE(event["dur"].get<double>(), 0);
        EXPECT_LT(event["tid"].get<std::uint32_t>(), pool.subgroups());
    }
}

}  // namespace
