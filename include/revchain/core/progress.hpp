// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>

#include "revchain/core/status.hpp"

namespace revchain {

/// What a long computation shares with another thread: how far it is, and whether it should stop.
class Progress {
   public:
    /// From 0 to 1; a hint, not a promise about time.
    double fraction() const { return fraction_.load(std::memory_order_relaxed); }
    void report(double fraction) { fraction_.store(fraction, std::memory_order_relaxed); }
    /// The computation throws `Cancelled` at its next look.
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

   private:
    std::atomic<double> fraction_ = 0;
    std::atomic<bool> cancelled_ = false;
};

namespace detail {
/// Nothing where nobody looks on.
inline void advance(Progress* progress, double fraction) {
    if (progress == nullptr) return;
    if (progress->cancelled()) throw Cancelled("revchain: cancelled");
    progress->report(fraction);
}
}  // namespace detail
}  // namespace revchain
