#include <fmt/format.h>

#include <algorithm>

#include "taskpool/pool/pool.hpp"

namespace taskpool::pool {
namespace {

std::uint64_t join(std::uint32_t low, std::uint32_t high) {
    return std::uint64_t{high} << 32 | low;
}

}  // namespace

std::string chrome_trace(std::span<const TraceRecord> records,
                         std::span<const std::string> phase_names) {
    std::uint64_t origin = ~std::uint64_t{0};
    for (const TraceRecord& r : records) origin = std::min(origin, join(r.begin_low, r.begin_high));
    std::string json = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[";
    const char* separator = "\n";
    for (const TraceRecord& r : records) {
        const std::uint64_t begin = join(r.begin_low, r.begin_high) - origin;
        const std::uint64_t end = join(r.end_low, r.end_high) - origin;
        const std::string name =
            r.phase < phase_names.size() ? phase_names[r.phase] : fmt::format("phase {}", r.phase);
        json += fmt::format(
            "{}{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":0,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f},"
            "\"args\":{{\"slot\":{},\"step\":{}}}}}",
            separator, name, r.subgroup, double(begin) * 1e-3, double(end - begin) * 1e-3,
            r.slot == kNoSlot ? -1 : std::int64_t{r.slot}, r.step);
        separator = ",\n";
    }
    return json + "\n]}\n";
}

}  // namespace taskpool::pool
