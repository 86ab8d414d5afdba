// What a validate() finds: the first lines, and how many more there were.
//
//     class Validator : Violations { ... fail("node {}: not reached", id); ... return take_lines();
//     };
#pragma once

#include <fmt/format.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace structures {

class Violations {
  protected:
    /// From any thread.
    template <typename... Args>
    void fail(fmt::format_string<Args...> format, Args&&... args) {
        const std::scoped_lock lock(mutex_);
        if (++failures_ <= kLinesAtMost)
            lines_.push_back(fmt::format(format, std::forward<Args>(args)...));
    }
    std::vector<std::string> take_lines() {
        if (failures_ > kLinesAtMost)
            lines_.push_back(fmt::format("and {} more violations", failures_ - kLinesAtMost));
        return std::move(lines_);
    }

  private:
    static constexpr std::size_t kLinesAtMost = 20;
    std::mutex mutex_;
    std::vector<std::string> lines_;
    std::size_t failures_ = 0;
};

}  // namespace structures
