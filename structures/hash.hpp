// FNV-1a over 32-bit words: what fingerprints of structures are made of.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace structures {

class Hash {
  public:
    /// The words of `value`, which has no padding.
    template <typename T>
    void add(const T& value) {
        for (const std::uint32_t word :
             std::bit_cast<std::array<std::uint32_t, sizeof(T) / 4>>(value))
            value_ = (value_ ^ word) * 1099511628211ull;
    }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace structures
