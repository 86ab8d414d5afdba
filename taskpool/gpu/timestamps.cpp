#include "taskpool/gpu/timestamps.hpp"

#include <algorithm>
#include <stdexcept>

namespace taskpool::gpu {

Timestamps::Timestamps(Device& device, std::uint32_t capacity)
    : device_(device), capacity_(capacity) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = capacity;
    check(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "vkCreateQueryPool");
}

Timestamps::~Timestamps() { vkDestroyQueryPool(device_.handle(), pool_, nullptr); }

std::uint64_t Timestamps::ticks(const std::string& label) const {
    const auto it = std::find(labels_.begin(), labels_.end(), label);
    if (it == labels_.end()) throw std::logic_error("no timestamp labelled '" + label + "'");
    std::uint64_t value = 0;
    check(vkGetQueryPoolResults(device_.handle(), pool_, std::uint32_t(it - labels_.begin()), 1,
                                sizeof(value), &value, sizeof(value),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    return value;
}

double Timestamps::milliseconds(const std::string& begin, const std::string& end) const {
    const auto difference = static_cast<double>(ticks(end) - ticks(begin));
    return difference * device_.info().timestamp_period_ns * 1e-6;
}

}  // namespace taskpool::gpu
