// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <future>

#include "bindings.hpp"
#include "revchain/core/progress.hpp"

/// solve(progress) with the GIL released. What may take more than `moments` (one is about 0.1 s; less than 1 is done
/// here) runs in a thread of its own while this one looks for Ctrl-C: Python notes the signal, but hears it only when asked.
template <class Result>
Result watched(double moments, revchain::Progress* progress, const std::function<Result(revchain::Progress*)>& solve) {
    const py::gil_scoped_release release;
    if (moments < 1) return solve(progress);

    revchain::Progress own;
    revchain::Progress* seen = progress != nullptr ? progress : &own;
    auto result = std::async(std::launch::async, [&] { return solve(seen); });
    while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() == 0) continue;
        seen->cancel();
        {
            const py::gil_scoped_release while_waiting;
            result.wait();
        }
        throw py::error_already_set();
    }
    return result.get();
}
