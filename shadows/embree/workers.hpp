// Threads that wait between queries, so that starting them is no part of a query's time.
//
//     Workers workers(2);
//     workers.run(chunk_count, [&](std::uint32_t chunk) { ... });   // returns when all are done
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace shadows::embree {

/// The threads flush denormals to zero, as Embree's manual demands of every thread that traces.
class Workers {
  public:
    /// 0 threads: one per core.
    explicit Workers(unsigned threads);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// Calls `task` once for each of 0 .. chunks - 1, each thread taking the next one when it is
    /// free. Rethrows the first exception of a task, after which the remaining chunks are skipped.
    void run(std::uint32_t chunks, const std::function<void(std::uint32_t)>& task);
    std::size_t count() const { return threads_.size(); }

  private:
    void serve();
    void take_chunks();

    std::mutex mutex_;
    std::condition_variable start_, done_;
    const std::function<void(std::uint32_t)>* task_ = nullptr;
    std::uint32_t chunks_ = 0;
    std::atomic<std::uint32_t> next_{0};
    std::uint64_t round_ = 0;  ///< counts calls of run()
    std::size_t busy_ = 0;
    bool stop_ = false;
    std::exception_ptr error_;
    std::vector<std::thread> threads_;
};

}  // namespace shadows::embree
