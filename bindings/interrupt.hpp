// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <thread>

#include "bindings.hpp"
#include "revchain/chain.hpp"

// Python notes Ctrl-C but hears it only when asked. The library calls `interrupt` from all its long loops, whichever
// function was bound: it asks there. See bind_core.cpp.

/// solve() in a thread of its own, for solvers of Eigen, which cannot be interrupted. After Ctrl-C, or where `progress`
/// is cancelled, the caller goes on at once. The thread ends at its next look or with the solver's result, which nobody
/// reads. `solve` owns all that it uses.
template <class Solve>
auto aside(const revchain::Progress* progress, Solve solve) {
    const auto stop = std::make_shared<std::atomic<bool>>(false);
    std::packaged_task<decltype(solve())()> task([stop, solve = std::move(solve)] {
        revchain::detail::abandoned = stop.get();
        return solve();
    });
    auto result = task.get_future();
    const py::gil_scoped_release release;
    std::thread(std::move(task)).detach();
    try {
        while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
            revchain::detail::check_interrupt();
            if (progress != nullptr && progress->cancelled()) throw revchain::Cancelled("revchain: cancelled");
        }
    } catch (...) {
        *stop = true;
        throw;
    }
    return result.get();
}

/// solve(chain), aside unless links are so few that they take less than 0.1 s, or too many for a dense matrix.
template <class Solve>
auto aside(const revchain::Chain<double>& chain, const revchain::Progress* progress, Solve solve) {
    if (chain.size() <= 40 || chain.size() > 20'000) return without_lock([&] { return solve(chain); });
    return aside(progress, [chain, solve = std::move(solve)] { return solve(chain); });
}
