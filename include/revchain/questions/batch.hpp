// SPDX-License-Identifier: MPL-2.0
// Defines what batch.hpp declares.
#pragma once

#include "revchain/batch.hpp"
#include "revchain/numeric/parallel.hpp"
#include "revchain/questions/batch_workers.hpp"

namespace revchain::inline REVCHAIN_BUILD {
namespace detail {

template <Real T>
void check(const ChainBatch<T>& batch, const BatchOptions& options) {
    constexpr std::string_view place = "conical_heights";
    if (batch.chains < 0)
        throw_invalid(place, "the number of chains must not be negative", batch.chains);
    if (batch.size < 1) throw_invalid(place, "a chain needs at least one link", batch.size);
    if (!batch.centroid && (batch.pendulum_length || batch.radius_of_gyration))
        throw_invalid(place, "pendulum_length and radius_of_gyration need the centroid");
    if (batch.centroid && batch.pendulum_length.has_value() == batch.radius_of_gyration.has_value())
        throw_invalid(place,
                      "a centroid needs either pendulum_length or radius_of_gyration (not both)");
    const Index count = options.count.value_or(1);
    if (count < 1) throw_invalid(place, "count must be at least 1", count);
    if (count > batch.size)
        throw_invalid(
            place, "count must not exceed the " + std::to_string(batch.size) + " links of a chain",
            count);
}

/// Computes all heights. If `looking` is true, it also checks every chain just before use, while it
/// is in the cache, and returns false as soon as a chain is not ordinary.
template <Real T>
bool compute(const ChainBatch<T>& batch, const BatchPlan& plan, const BatchOptions& options,
             bool looking, Table<T>& heights) {
    constexpr Index together = 256;  // chains; a multiple of the lanes
    std::atomic<bool> unusual = false;
    parallel_for(batch.chains, together, [&](Index begin, Index end) {
        BatchWorker<T> worker(batch, plan, heights);
        for (Index first = begin; first < end && !unusual; first += together) {
            const Index last = std::min(first + together, end);
            if (looking && !ordinary(batch, first, last)) {
                unusual = true;
                return;
            }
            worker.run(first, last);
            const double share = static_cast<double>(last) / static_cast<double>(batch.chains);
            advance(options.progress, share);
        }
        if (!unusual) worker.finish(options.progress);
    });
    return !unusual;
}

}  // namespace detail

template <Real T>
Table<T> conical_heights(const ChainBatch<T>& batch, const BatchOptions& options) {
    detail::check(batch, options);
    const detail::Threads threads("conical_heights", options.threads);
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
