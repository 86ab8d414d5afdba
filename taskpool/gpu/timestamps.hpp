// GPU times of a recorded command sequence.
#pragma once

#include <string>
#include <vector>

#include "taskpool/gpu/device.hpp"

namespace taskpool::gpu {

/// Move-only. Filled by Recorder::timestamp, read after Device::run.
class Timestamps {
  public:
    /// Room for `capacity` timestamps between two clear()s.
    Timestamps(Device& device, std::uint32_t capacity);
    ~Timestamps();
    Timestamps(const Timestamps&) = delete;
    Timestamps& operator=(const Timestamps&) = delete;

    /// Forgets all labels, for the next recording.
    void clear() { labels_.clear(); }
    /// Milliseconds from the first timestamp labelled `begin` to the first labelled `end`, on the
    /// device. Throws std::logic_error for an unknown label.
    double milliseconds(const std::string& begin, const std::string& end) const;

    VkQueryPool handle() const { return pool_; }
    std::uint32_t capacity() const { return capacity_; }
    const std::vector<std::string>& labels() const { return labels_; }

  private:
    friend class Recorder;
    std::uint64_t ticks(const std::string& label) const;

    Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t capacity_ = 0;
    std::vector<std::string> labels_;
};

}  // namespace taskpool::gpu
