// GPU work that may take several launches: it records, its owner submits.
//
//     struct Build : Job { ... };
//     RunStats stats = run(device, build);      // record, submit, advance until done
#pragma once

#include <functional>

#include "taskpool/gpu/recorder.hpp"

namespace taskpool::pool {

class Job {
  public:
    virtual ~Job() = default;
    /// Puts the job back to its beginning; the next record() starts it anew.
    virtual void restart() = 0;
    /// Records the next launch. Never submits.
    virtual void record(gpu::Recorder& recorder) = 0;
    /// To be called when the recorded launch has finished: reads its status, grows what ran full.
    /// True if another launch is needed. Throws gpu::Error if the job cannot be finished.
    virtual bool advance() = 0;
    /// Finished fraction, 0 to 1, as far as known; for progress bars.
    virtual double progress() const { return 0; }
};

struct RunStats {
    double gpu_ms = 0;   ///< device time of all launches (wall time without timestamps)
    double wall_ms = 0;  ///< including submission, read-back and growth
    std::uint32_t launches = 0;
};

/// Restarts `job` and runs it to its end. `on_launch` is called after each launch and cancels the
/// job by returning false (std::runtime_error "cancelled").
RunStats run(gpu::Device& device, Job& job, const std::function<bool(const Job&)>& on_launch = {});

}  // namespace taskpool::pool
