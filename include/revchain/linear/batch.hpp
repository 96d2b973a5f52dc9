// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <vector>

#include "revchain/core/progress.hpp"
#include "revchain/linear/batch_workers.hpp"

namespace revchain {

namespace detail {

/// All heights, on all threads. With `looking`, every chain is looked at just before it is needed, while it is in the
/// cache, and false returned as soon as one is not ordinary.
template <Real T>
bool compute(const ChainBatch<T>& batch, const BatchPlan& plan, const BatchOptions& options, bool looking,
             Table<T>& heights) {
    constexpr Index together = 256;  // chains; a multiple of the lanes
    const Index slices = (batch.chains + together - 1) / together;
    const Index threads = std::max<Index>(1, std::min(options.threads, slices));
    std::atomic<bool> unusual = false;
    const auto part = [&](Index t) {
        std::conditional_t<fits_lanes<T>, LaneWorker<T>, SingleWorker<T>> worker(batch, plan, heights);
        for (Index slice = slices * t / threads; slice < slices * (t + 1) / threads && !unusual; ++slice) {
            const Index first = slice * together, last = std::min(first + together, batch.chains);
            if (looking && !ordinary(batch, first, last)) {
                unusual = true;
                return;
            }
            worker.run(first, last);
            advance(options.progress, static_cast<double>(last) / static_cast<double>(batch.chains));
        }
        if (!unusual) worker.finish(options.progress);
    };
    std::vector<std::future<void>> others;
    for (Index t = 1; t < threads; ++t) others.push_back(std::async(std::launch::async, part, t));
    try {
        part(0);
        for (auto& other : others) {
            while (other.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) look();
            other.get();
        }
    } catch (...) {
        unusual = true;  // the others end at their next look
        throw;
    }
    return !unusual;
}

}  // namespace detail

/// The slowest `count` conical heights of every chain of a batch, descending: a row for each chain, in its unit of
/// length. Greenhill (1908) §8 (21) with sec delta = 1.
///
/// In float and double one chain to a SIMD lane (linalg/lane_spectrum.hpp); chains for which that proves nothing, those
/// with massless links or centroids at or above the pin, and all chains in other scalars are done one by one by `modes`.
/// Accuracy: 2.8 ulp for plummets and rods up to N = 100; in a million chains of all kinds of 1 to 6 links 29 heights were
/// off by more than 4 ulp, the worst by 4.8, all where weights span 1e12 or the mass of a link is one point between its
/// pins. Verified by counts to 16 + N/4 ulp.
/// Results are bitwise the same whatever the number of threads, the place of a chain in the batch and its neighbours
/// there; another `count` or another kind of processor may change last digits.
/// Cost, all modes, N = 10: 0.24 microseconds for plummets, 0.36 for rods (bench/batch.cpp). Memory: the result, and a few
/// numbers for each link of 16 chains a thread.
///
/// Throws InvalidArgument for a batch, count or number of threads that is none, and, before anything else, for the first
/// chain with a number that `Chain` refuses, naming chain, link and value; for a count beyond the modes of some
/// chain (massless links cost modes: chains that have unlike numbers of modes need a count). Throws it later only for a
/// chain whose heights cannot be proved to half the digits of T.
template <Real T>
Table<T> conical_heights(const ChainBatch<T>& batch, const BatchOptions& options = {}) {
    detail::check(batch, options);
    if (detail::fits_lanes<T>) {
        const detail::BatchPlan plan{options.count.value_or(batch.size), {}};
        Table<T> heights(batch.chains, plan.count);
        if (detail::compute(batch, plan, options, true, heights)) return heights;
    }
    const detail::BatchPlan plan = detail::look_at_each(batch, options);
    Table<T> heights(batch.chains, plan.count);
    detail::compute(batch, plan, options, false, heights);
    return heights;
}

}  // namespace revchain
