// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>

#include "revchain/numeric/status.hpp"

namespace revchain::inline REVCHAIN_BUILD {

/// State that a long computation shares with another thread: its progress, and a request to stop.
class Progress {
   public:
    /// The fraction of the work that is done: a hint, not a promise about time.
    double fraction() const { return fraction_.load(std::memory_order_relaxed); }
    void report(double fraction) { fraction_.store(fraction, std::memory_order_relaxed); }
    /// Requests a stop. The computation throws `Cancelled` when it next calls `advance`.
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

   private:
    std::atomic<double> fraction_ = 0;
    std::atomic<bool> cancelled_ = false;
};

namespace detail {
/// A function that a program may set before it computes. Every loop that can take longer than 0.1 s
/// calls it at least every 0.1 s, on its own thread. An exception from it ends the computation.
inline std::atomic<void (*)()> interrupt = nullptr;
/// Points to a flag that is true once the result of this thread is no longer needed; null if that
/// cannot happen.
inline thread_local const std::atomic<bool>* abandoned = nullptr;
/// Calls `interrupt`. Throws Cancelled on a thread that has been abandoned.
inline void check_interrupt() {
    if (abandoned != nullptr && *abandoned) throw Cancelled("revchain: cancelled");
    if (void (*const call)() = interrupt.load(std::memory_order_relaxed)) call();
}

/// Calls `check_interrupt`, then reports the fraction to `progress`, if given, or throws Cancelled.
inline void advance(Progress* progress, double fraction) {
    check_interrupt();
    if (progress == nullptr) return;
    if (progress->cancelled()) throw Cancelled("revchain: cancelled");
    progress->report(fraction);
}
}  // namespace detail
}  // namespace revchain
