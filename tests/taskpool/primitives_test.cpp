// Scan, compaction and radix sort against the standard library.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "taskpool/primitives/blocks.hpp"
#include "taskpool/primitives/radix_sort.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace {

using namespace taskpool::gpu;
using namespace taskpool::primitives;
using Primitives = tests::GpuTest;
using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kGuard = 0xdeadbeef;

/// Sizes around everything that could matter: subgroups, quads, blocks.
std::vector<std::uint32_t> sizes(std::uint32_t most) {
    const std::uint32_t lanes = tests::device().subgroup_size();
    std::vector<std::uint32_t> all;
    for (std::uint32_t size :
         {0u, 1u, lanes - 1, lanes, lanes + 1, 4 * lanes - 1, 4 * lanes + 1, 255u, 256u, 257u,
          4095u, 4097u, 65535u, 65536u, 65537u, 1'000'000u, 10'000'000u})
        if (size <= most) all.push_back(size);
    return all;
}

Words random_words(std::size_t count, std::uint32_t seed, std::uint32_t below) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::uint32_t> distribution(0, below - 1);
    Words words(count);
    for (std::uint32_t& word : words) word = distribution(random);
    return words;
}

/// A buffer with a guard word behind its `count` words.
Buffer guarded(std::size_t count, const char* name) {
    return make_buffer<std::uint32_t>(tests::device(), Words(count + 1, kGuard), name);
}

void expect_guard(const Buffer& buffer, std::size_t count) {
    EXPECT_EQ(read<std::uint32_t>(buffer, 1, count)[0], kGuard) << buffer.name();
}

template <typename Record>
void run(const Record& record) {
    Recorder recorder(tests::device());
    record(recorder);
    tests::device().run(recorder);
}

TEST_F(Primitives, ScanIsThatOfTheStandardLibrary) {
    Device& device = tests::device();
    const Scan scan(device);
    std::uint32_t seed = 1;
    for (std::uint32_t count : sizes(10'000'000)) {
        SCOPED_TRACE(fmt::format("{} elements, seed {}", count, ++seed));
        const Words values = random_words(count, seed, 0xffffffffu);  // sums wrap around
        Words expected(count);
        std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);
        const std::uint32_t sum = std::accumulate(values.begin(), values.end(), 0u);
        const Buffer source = make_buffer<std::uint32_t>(device, values, "source");
        const Buffer target = guarded(count, "target"), total = guarded(1, "total");
        const Buffer scratch = guarded(scan.scratch_bytes(count) / 4, "scratch");
        run([&](Recorder& r) { scan.record(r, source, target, count, scratch, total); });
        EXPECT_TRUE(read<std::uint32_t>(target, count) == expected);
        EXPECT_EQ(read<std::uint32_t>(total, 1)[0], sum);
        run([&](Recorder& r) { scan.record(r, source, source, count, scratch); });
        EXPECT_TRUE(read<std::uint32_t>(source, count) == expected) << "in place";
        expect_guard(target, count);
        expect_guard(total, 1);
        expect_guard(scratch, scan.scratch_bytes(count) / 4);
    }
}

TEST_F(Primitives, CompactionKeepsFlaggedValuesInOrder) {
    Device& device = tests::device();
    const Compact compact(device);
    std::uint32_t seed = 1;
    for (std::uint32_t count : sizes(1'000'000))
        for (std::uint32_t kind = 0; kind < 3; ++kind) {  // none, all, some kept
            SCOPED_TRACE(fmt::format("{} elements, kind {}, seed {}", count, kind, ++seed));
            Words flags = random_words(count, seed, 2);
            for (std::uint32_t& flag : flags) flag = kind == 0 ? 0 : kind == 1 ? ~0u : flag << 31;
            const Words values = random_words(count, seed + 1000, 0xffffffffu);
            Words kept_values, kept_indices;
            for (std::uint32_t i = 0; i < count; ++i)
                if (flags[i]) {
                    kept_values.push_back(values[i]);
                    kept_indices.push_back(i);
                }
            const Buffer in = make_buffer<std::uint32_t>(device, flags, "flags");
            const Buffer of = make_buffer<std::uint32_t>(device, values, "values");
            const Buffer target = guarded(count, "target"), indices = guarded(count, "indices");
            const Buffer kept = guarded(1, "kept"), kept_too = guarded(1, "kept too");
            const Buffer scratch = guarded(compact.scratch_bytes(count) / 4, "scratch");
            run([&](Recorder& r) {
                compact.record(r, in, of, target, kept, count, scratch);
                compact.record(r, in, {}, indices, kept_too, count, scratch);
            });
            EXPECT_EQ(read<std::uint32_t>(kept, 1)[0], kept_values.size());
            EXPECT_EQ(read<std::uint32_t>(kept_too, 1)[0], kept_values.size());
            EXPECT_TRUE(read<std::uint32_t>(target, kept_values.size()) == kept_values);
            EXPECT_TRUE(read<std::uint32_t>(indices, kept_values.size()) == kept_indices);
            expect_guard(target, kept_values.size());
            expect_guard(indices, kept_values.size());
            expect_guard(kept, 1);
            expect_guard(scratch, compact.scratch_bytes(count) / 4);
        }
}

/// Sorts `keys` (words_per_key words each) with their indices as payload, and compares with
/// std::stable_sort on the low `bits` bits.
void check_sort(const RadixSort& sort, const Words& keys, std::uint32_t words_per_key,
                std::uint32_t bits) {
    Device& device = tests::device();
    const auto count = std::uint32_t(keys.size() / words_per_key);
    const auto key = [&](std::uint32_t i) {
        std::uint64_t value = keys[std::size_t{i} * words_per_key];
        if (words_per_key == 2) value |= std::uint64_t{keys[std::size_t{i} * 2 + 1]} << 32;
        return bits == 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
    };
    Words indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
    Words order = indices, expected_keys;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::uint32_t i : order)
        for (std::uint32_t word = 0; word < words_per_key; ++word)
            expected_keys.push_back(keys[std::size_t{i} * words_per_key + word]);

    const Buffer in = make_buffer<std::uint32_t>(device, keys, "keys");
    const Buffer payload = make_buffer<std::uint32_t>(device, indices, "values");
    const Buffer sorted = guarded(keys.size(), "sorted keys");
    const Buffer sorted_payload = guarded(count, "sorted values");
    const Buffer scratch = guarded(sort.scratch_bytes(count) / 4, "scratch");
    run([&](Recorder& r) {
        sort.record(r, {in, payload, sorted, sorted_payload, scratch, count, bits});
    });
    EXPECT_TRUE(read<std::uint32_t>(sorted, keys.size()) == expected_keys);
    EXPECT_TRUE(read<std::uint32_t>(sorted_payload, count) == order) << "not stable";
    EXPECT_TRUE(read<std::uint32_t>(in, keys.size()) == keys);
    expect_guard(sorted, keys.size());
    expect_guard(sorted_payload, count);
    expect_guard(scratch, sort.scratch_bytes(count) / 4);
}

TEST_F(Primitives, SortIsStableAndThatOfTheStandardLibrary) {
    const RadixSort sort(tests::device(), RadixSort::Key::u32);
    std::uint32_t seed = 1;
    for (std::uint32_t count : sizes(1'000'000))
        for (std::uint32_t below : {1u, 5u, 0xffffffffu}) {  // equal, few, many different keys
            SCOPED_TRACE(fmt::format("{} keys below {}, seed {}", count, below, ++seed));
            check_sort(sort, random_words(count, seed, below), 1, 32);
        }
}

TEST_F(Primitives, SortLooksAtTheLowBitsOnly) {
    const RadixSort sort(tests::device(), RadixSort::Key::u32);
    for (std::uint32_t bits : {1u, 7u, 8u, 9u, 16u, 24u, 30u, 31u}) {
        SCOPED_TRACE(fmt::format("{} bits", bits));
        check_sort(sort, random_words(20'000, bits, 0xffffffffu), 1, bits);
    }
}

TEST_F(Primitives, SortOfWideKeys) {
    const RadixSort sort(tests::device(), RadixSort::Key::u64);
    std::uint32_t seed = 1;
    for (std::uint32_t count : sizes(65537)) {
        SCOPED_TRACE(fmt::format("{} keys, seed {}", count, ++seed));
        check_sort(sort, random_words(2 * count, seed, 0xffffffffu), 2, 64);
        check_sort(sort, random_words(2 * count, seed, 3), 2, 63);
    }
    check_sort(sort, random_words(40'000, 77, 0xffffffffu), 2, 40);
}

TEST_F(Primitives, SortedAndReversedKeys) {
    const RadixSort sort(tests::device(), RadixSort::Key::u32);
    Words keys(100'000);
    std::iota(keys.begin(), keys.end(), 0xfffe7960u);
    check_sort(sort, keys, 1, 32);
    std::reverse(keys.begin(), keys.end());
    check_sort(sort, keys, 1, 32);
}

TEST_F(Primitives, BlocksStayWithinLoopAndDispatchLimits) {
    for (std::uint32_t step : {4u, 8u, 32u, 64u, 256u})
        for (std::uint32_t elements : {1u, 100u, 1'000'000u, 300'000'000u, kMaxCount}) {
            const Blocks blocks = cut(elements, step, 16);
            EXPECT_LE(blocks.count, 65535u);
            EXPECT_EQ(blocks.length % step, 0u);
            EXPECT_GE(std::uint64_t{blocks.count} * blocks.length, elements);
            EXPECT_LT((std::uint64_t{blocks.count} - 1) * blocks.length, elements);
            if (step > 4) {  // with less, kMaxCount elements need more than 65535 workgroups
                EXPECT_LE(blocks.length / step, 30'000u);
            }
        }
    EXPECT_EQ(cut(0, 8, 16).count, 0u);
}

TEST_F(Primitives, ShortRangesAreNamed) {
    Device& device = tests::device();
    const Scan scan(device);
    const RadixSort sort(device, RadixSort::Key::u32);
    const Buffer small(device, 40, "small"), large(device, 1 << 20, "large");
    Recorder recorder(device);
    try {
        scan.record(recorder, small, large, 11, large);
        FAIL() << "read beyond the source";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "scan: source holds 40 bytes, 44 are needed");
    }
    EXPECT_THROW(sort.record(recorder, {small, small, large, large, small, 10}),
                 std::invalid_argument);
    EXPECT_THROW(sort.record(recorder, {small, small, large, large, large, 10, 33}),
                 std::invalid_argument);
    EXPECT_THROW(sort.record(recorder, {small, small, large, large, large, 10, 0}),
                 std::invalid_argument);
}

}  // namespace
