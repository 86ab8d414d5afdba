// The Vulkan runtime: buffers, kernels, recording, timestamps, and what its errors say.
#include <gmock/gmock.h>

#include <numeric>

#include "taskpool/gpu/recorder.hpp"
#include "tests/support/gpu_fixture.hpp"

std::span<const taskpool::gpu::Shader> tests_taskpool_gpu_shaders();

namespace {

using namespace taskpool::gpu;
using Runtime = tests::GpuTest;
using testing::HasSubstr;

struct EchoPush {
    std::uint64_t source, target;
    std::uint32_t count;
};

std::vector<std::uint32_t> iota(std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 7u);
    return values;
}

const Shader& echo() {
    return find_shader(tests_taskpool_gpu_shaders(), "tests/taskpool/echo.comp");
}

TEST_F(Runtime, KernelsReadAndWriteBuffersAtAnySize) {
    Device& device = tests::device();
    const std::uint32_t lanes = device.subgroup_size();
    const Kernel kernel(device, echo(), {{1, 5u}});
    for (std::uint32_t count : {0u, 1u, lanes - 1, lanes, lanes + 1, 100'000u}) {
        const auto values = iota(count);
        const Buffer source = make_buffer<std::uint32_t>(device, values, "source");
        const Buffer target(device, count * 4, "target");
        Timestamps times(device, 2);
        Recorder recorder(device);
        recorder.fill(target, 0);
        recorder.barrier();
        recorder.timestamp(times, "begin");
        recorder.dispatch(kernel, EchoPush{source.address(), target.address(), count}, 3);
        recorder.timestamp(times, "end");
        recorder.barrier();
        device.run(recorder);
        const auto result = read<std::uint32_t>(target, count);
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(result[i], values[i] + 5);
        EXPECT_GE(times.milliseconds("begin", "end"), 0);
        EXPECT_THROW(times.milliseconds("begin", "nowhere"), std::logic_error);
    }
}

TEST_F(Runtime, IndirectDispatchCopyAndFill) {
    Device& device = tests::device();
    const auto values = iota(1000);
    const Buffer source = make_buffer<std::uint32_t>(device, values, "source");
    const Buffer target(device, 4000, "target"), copy(device, 4000, "copy");
    const Buffer groups =
        make_buffer<std::uint32_t>(device, std::vector<std::uint32_t>{9, 2, 1, 1}, "groups");
    const Kernel kernel(device, echo());
    Recorder recorder(device);
    recorder.dispatch_indirect(kernel, EchoPush{source.address(), target.address(), 1000}, groups,
                               4);
    recorder.fill(copy, 0xffffffffu);
    recorder.barrier();
    recorder.copy(target, copy, 400, 40, 80);
    recorder.barrier();
    device.run(recorder);
    const auto result = read<std::uint32_t>(copy, 1000);
    for (std::uint32_t i = 0; i < 1000; ++i)
        ASSERT_EQ(result[i], i >= 20 && i < 120 ? values[i - 10] : 0xffffffffu) << i;
}

TEST_F(Runtime, MemoryIsCounted) {
    Device& device = tests::device();
    const std::uint64_t before = device.allocated_bytes();
    device.reset_peak();
    {
        const Buffer buffer(device, 1 << 20, "counted");
        EXPECT_GE(device.allocated_bytes(), before + (1 << 20));
    }
    EXPECT_EQ(device.allocated_bytes(), before);
    EXPECT_GE(device.peak_bytes(), before + (1 << 20));
}

TEST_F(Runtime, ErrorsSayWhatAndWhere) {
    Device& device = tests::device();
    Buffer small(device, 8, "small");
    EXPECT_THROW(read<std::uint32_t>(small, 3), std::out_of_range);
    EXPECT_THROW(find_shader(tests_taskpool_gpu_shaders(), "no/such.comp"), std::logic_error);
    try {
        const Buffer huge(device, std::size_t{1} << 60, "huge");
        FAIL() << "an exbibyte was allocated";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("'huge'"));
        EXPECT_THAT(error.what(), HasSubstr("MiB"));
    }
    try {
        DeviceOptions options;
        options.index = 1000;
        const Device none(options);
        FAIL() << "device 1000 exists";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("no device 1000"));
    }
    EXPECT_THAT(device_lost_message("gpu", "a/b.comp"), HasSubstr("kernel a/b.comp"));
    EXPECT_THAT(device_lost_message("gpu", ""), HasSubstr("a transfer"));
}

TEST_F(Runtime, ShaderSourceReplacesEmbeddedCode) {
    DeviceOptions options;
    std::string asked;
    options.shader_source =
        [&](std::string_view path) -> std::optional<std::vector<std::uint32_t>> {
        asked = path;
        return std::nullopt;
    };
    Device device(options);
    const Kernel kernel(device, echo());
    EXPECT_EQ(asked, "tests/taskpool/echo.comp");
}

TEST_F(Runtime, DevicesAreListedBestFirst) {
    const auto devices = list_devices();
    ASSERT_FALSE(devices.empty());
    for (std::size_t i = 1; i < devices.size(); ++i)
        EXPECT_LE(devices[i - 1].type, devices[i].type);
    EXPECT_GE(devices[0].subgroup_size, 1u);
}

}  // namespace
