#include "taskpool/pool/job.hpp"

#include <chrono>
#include <stdexcept>

namespace taskpool::pool {

RunStats run(gpu::Device& device, Job& job, const std::function<bool(const Job&)>& on_launch) {
    using Clock = std::chrono::steady_clock;
    using Milliseconds = std::chrono::duration<double, std::milli>;
    const bool timed = device.info().timestamp_period_ns > 0;
    gpu::Timestamps timestamps(device, 2);
    RunStats stats;
    const auto begin = Clock::now();
    job.restart();
    for (bool again = true; again;) {
        const auto launched = Clock::now();
        gpu::Recorder recorder(device);
        timestamps.clear();
        if (timed) recorder.timestamp(timestamps, "begin");
        job.record(recorder);
        if (timed) recorder.timestamp(timestamps, "end");
        recorder.barrier();
        device.run(recorder);
        ++stats.launches;
        stats.gpu_ms += timed ? timestamps.milliseconds("begin", "end")
                              : Milliseconds(Clock::now() - launched).count();
        again = job.advance();
        if (on_launch && !on_launch(job)) throw std::runtime_error("cancelled");
    }
    stats.wall_ms = Milliseconds(Clock::now() - begin).count();
    return stats;
}

}  // namespace taskpool::pool
