// Traces as text; pool.hpp describes the format.
#include <fmt/format.h>

#include <algorithm>

#include "taskpool/pool/pool.hpp"

namespace taskpool::pool {
std::string chrome_trace(std::span<const TraceRecord> records,
                         std::span<const std::string> phase_names) {
    std::string json = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[";
    const char* separator = "\n";
    // The clock is 32 bits of nanoseconds; records come nearly in order, so that the signed
    // difference to the one before puts each into place.
    std::int64_t now = 0;
    std::uint32_t clock = records.empty() ? 0 : records.front().begin;
    for (const TraceRecord& r : records) {
        now += static_cast<std::int32_t>(r.begin - clock);
        clock = r.begin;
        const std::uint32_t duration = r.end - r.begin;
        const std::string name =
            r.phase < phase_names.size() ? phase_names[r.phase] : fmt::format("phase {}", r.phase);
        json += fmt::format(
            "{}{{\"name\":\"{}\",\"ph\":\"X\",\"pid\":0,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f},"
            "\"args\":{{\"slot\":{},\"step\":{}}}}}",
            separator, name, r.subgroup, double(now) * 1e-3, double(duration) * 1e-3,
            r.slot == kNoSlot ? -1 : std::int64_t{r.slot}, r.step);
        separator = ",\n";
    }
    return json + "\n]}\n";
}

}  // namespace taskpool::pool
