// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/batch.hpp"
#include "revchain/questions/batch_workers.hpp"

namespace revchain {

namespace detail {

template <Real T>
void check(const ChainBatch<T>& batch, const BatchOptions& options) {
    constexpr std::string_view place = "conical_heights";
    if (batch.chains < 0) throw_invalid(place, "the number of chains must not be negative", batch.chains);
    if (batch.size < 1) throw_invalid(place, "a chain needs at least one link", batch.size);
    if (!batch.centroid && (batch.pendulum_length || batch.radius_of_gyration))
        throw_invalid(place, "pendulum_length and radius_of_gyration need the centroid");
    if (batch.centroid && batch.pendulum_length.has_value() == batch.radius_of_gyration.has_value())
        throw_invalid(place, "a centroid needs either pendulum_length or radius_of_gyration (not both)");
    if (options.count && *options.count < 1) throw_invalid(place, "count must be at least 1", *options.count);
    if (options.count && *options.count > batch.size)
        throw_invalid(place, "count must not exceed the " + std::to_string(batch.size) + " links of a chain",
                      *options.count);
    if (options.threads < 1) throw_invalid(place, "threads must be at least 1", options.threads);
}

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
        BatchWorker<T> worker(batch, plan, heights);
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

template <Real T>
Table<T> conical_heights(const ChainBatch<T>& batch, const BatchOptions& options) {
    detail::check(batch, options);
    if (detail::fits_lanes<T>) {
        const detail::BatchPlan plan{options.count.value_or(batch.size), {}};
        Table<T> heights(batch.chains, plan.count);
        if (detail::compute(batch, plan, options, true, heights)) return heights;
    }
    const detail::BatchPlan plan = detail::classify(batch, options.count);
    Table<T> heights(batch.chains, plan.count);
    detail::compute(batch, plan, options, false, heights);
    return heights;
}

}  // namespace revchain
