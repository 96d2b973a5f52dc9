// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <concepts>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <type_traits>
#include <vector>

#include "revchain/numeric/floating_point_state.hpp"
#include "revchain/numeric/progress.hpp"
#include "revchain/numeric/scalar.hpp"
#include "revchain/numeric/status.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// While it exists, `parallel_for` on the same thread uses this many threads, or with 0 all
/// processors. Otherwise, and on threads that it starts, it uses 1. Throws if `threads` is
/// negative.
class Threads {
   public:
    Threads(std::string_view place, Index threads) : before_(used_) {
        if (threads < 0) throw_invalid(place, "threads must not be negative", threads);
        used_ = threads > 0 ? threads : processors();
    }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
    ~Threads() { used_ = before_; }
    static Index used() { return used_; }

   private:
    /// Returns the number of processors. It reads a file, so it is not called often.
    static Index processors() {
        return std::max<Index>(1, static_cast<Index>(std::thread::hardware_concurrency()));
    }

    static inline thread_local Index used_ = 1;
    Index before_;
};

/// A function f(begin, end) by reference, so that one function starts threads for any computation.
struct RangeFunction {
    const void* function;
    void (*call)(const void* function, Index begin, Index end);
    void operator()(Index begin, Index end) const { call(function, begin, end); }
};

/// Does `parallel_for` on several threads.
inline void on_threads(Index threads, Index count, Index chunk, const RangeFunction& f) {
    const Index chunks = (count + chunk - 1) / chunk,
                range = std::max<Index>(1, chunks / (8 * threads)) * chunk;
    std::atomic<Index> next = 0;
    std::atomic<bool> stop = false;
    std::exception_ptr thrown;
    std::mutex mutex;  // protects `running`
    std::condition_variable ended;
    Index running = 0;
    const auto attempt = [&](const auto& work) {
        try {
            work();
        } catch (...) {
            if (!stop.exchange(true)) thrown = std::current_exception();
        }
    };
    const auto ranges = [&] {
        while (!stop) {
            const Index begin = next.fetch_add(range);
            if (begin >= count) return;
            f(begin, std::min(begin + range, count));
        }
    };
    const auto helper = [&] {
        const FloatingPointStateGuard quiet;
        abandoned = &stop;
        attempt(ranges);
        const std::scoped_lock lock(mutex);
        --running;
        ended.notify_one();
    };
    std::vector<std::thread> helpers;
    attempt([&] {
        try {
            for (Index t = 1; t < threads; ++t) {
                const std::scoped_lock lock(mutex);
                helpers.emplace_back(helper);
                ++running;
            }
        } catch (const std::system_error&) {
        }  // no more threads: those that started do the work
        ranges();
        std::unique_lock lock(mutex);
        while (running > 0) {
            ended.wait_for(lock, std::chrono::milliseconds(50));
            lock.unlock();
            check_interrupt();
            lock.lock();
        }
    });
    for (std::thread& each : helpers) each.join();
    if (thrown) std::rethrow_exception(thrown);
}

/// Calls f(begin, end) for ranges that together are 0 ... count - 1, on `Threads::used()` threads.
/// Ranges begin at multiples of `chunk`. With one thread or chunk there is one range, and no thread
/// is started. Results do not depend on the number of threads if f treats each chunk by itself. The
/// first exception reaches the caller after all threads have ended; they stop at their next
/// `check_interrupt`. The caller calls `check_interrupt` every 50 ms, if f does. Cost: 50
/// microseconds for each started thread.
template <std::integral I, class F>
void parallel_for(I count, std::type_identity_t<I> chunk, const F& f) {
    const I chunks = (count + chunk - 1) / chunk,
            threads = std::min(static_cast<I>(Threads::used()), chunks);
    if (threads > 1)
        on_threads(
            static_cast<Index>(threads), static_cast<Index>(count), static_cast<Index>(chunk),
            {&f, [](const void* function, Index begin, Index end) {
                 (*static_cast<const F*>(function))(static_cast<I>(begin), static_cast<I>(end));
             }});
    else if (count > 0)
        f(I(0), count);
}

}  // namespace revchain::detail
