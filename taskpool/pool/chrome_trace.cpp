// Traces as text; pool.hpp describes the format.
#include <fmt/format.h>

#include <algorithm>

#include "taskpool/pool/pool.hpp"

namespace taskpool::pool {
std::string chrome_trace(std::span<const TraceRecord> records,
                         std::span<const std::string> phase_names) {
    std::uint64_t origin = ~std::uint64_t{0};
    for (const TraceRecord& r : records) origin = std::min(origin, r.begin);
    std::string json = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[";
    const char* separator = "\n";
    for (const TraceRecord& r : records) {
        const std::uint64_t begin = r.begin - origin;
        const std::uint64_t end = r.end - origin;
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
