#include "tests/support/gpu_fixture.hpp"

#include <cstdio>
#include <memory>
#include <mutex>

namespace tests {
namespace {

std::mutex mutex;
std::vector<std::string> messages;

std::unique_ptr<taskpool::gpu::Device> create() {
    taskpool::gpu::DeviceOptions options;
    options.validation = true;
    options.on_validation_message = [](const std::string& message) {
        const std::lock_guard lock(mutex);
        messages.push_back(message);
    };
    auto created = std::make_unique<taskpool::gpu::Device>(options);
    if (!created->validating())
        std::fprintf(stderr,
                     "NOTE: vulkan-validationlayers is not installed; tests run without it\n");
    return created;
}

}  // namespace

taskpool::gpu::Device& device() {
    static const std::unique_ptr<taskpool::gpu::Device> shared = create();
    return *shared;
}

std::vector<std::string> take_validation_messages() {
    const std::lock_guard lock(mutex);
    return std::exchange(messages, {});
}

}  // namespace tests
