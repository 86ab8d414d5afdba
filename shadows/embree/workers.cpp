#include "shadows/embree/workers.hpp"

#include <algorithm>

#if defined(__SSE3__) || defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace shadows::embree {
namespace {

void flush_denormals() {
#if defined(__SSE3__) || defined(__x86_64__)
    constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
#endif
}

}  // namespace

Workers::Workers(unsigned threads) {
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < threads; ++i) threads_.emplace_back([this] { serve(); });
}

Workers::~Workers() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    start_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Workers::run(std::uint32_t chunks, const std::function<void(std::uint32_t)>& task) {
    std::unique_lock lock(mutex_);
    task_ = &task;
    chunks_ = chunks;
    next_ = 0;
    error_ = nullptr;
    busy_ = threads_.size();
    ++round_;
    start_.notify_all();
    done_.wait(lock, [this] { return busy_ == 0; });
    if (error_) std::rethrow_exception(error_);
}

void Workers::serve() {
    flush_denormals();
    std::unique_lock lock(mutex_);
    for (std::uint64_t seen = 0;;) {
        start_.wait(lock, [&] { return stop_ || round_ != seen; });
        if (stop_) return;
        seen = round_;
        lock.unlock();
        take_chunks();
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

void Workers::take_chunks() {
    try {
        for (std::uint32_t chunk; (chunk = next_.fetch_add(1)) < chunks_;) (*task_)(chunk);
    } catch (...) {
        next_ = chunks_;
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
    }
}

}  // namespace shadows::embree
