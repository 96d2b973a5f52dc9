// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "revchain/linear/chain_batch.hpp"

namespace revchain::detail {

/// Whether good(x) for every number stored, without a branch: compilers vectorise it.
template <Real T, class Good>
bool all(const BatchColumn<T>& column, Index chains, Index size, Good good) {
    if (column.chain_stride == 0) chains = std::min<Index>(chains, 1);
    if (column.link_stride == 0) size = 1;
    if (column.link_stride == 1 && column.chain_stride == size) {
        size *= chains;
        chains = std::min<Index>(chains, 1);
    }
    bool fine = true;
    for (Index c = 0; c < chains; ++c) {
        const T* const numbers = column.data + c * column.chain_stride;
        if (column.link_stride == 1)
            for (Index m = 0; m < size; ++m) fine &= good(numbers[m]);
        else
            for (Index m = 0; m < size; ++m) fine &= good(numbers[m * column.link_stride]);
    }
    return fine;
}

/// Whether every chain from `first` to `last` - 1 is one for the lanes: weights, lengths and centroids positive and far
/// from the ends of the range, radii of gyration real. Any such chain is valid and has as many modes as links.
template <Real T>
bool ordinary(const ChainBatch<T>& batch, Index first, Index last) {
    const auto part = [&](BatchColumn<T> column) {
        column.data += first * column.chain_stride;
        return column;
    };
    using std::ldexp;
    const T largest = ldexp(T(1), std::numeric_limits<T>::max_exponent * 2 / 5), smallest = T(1) / largest;
    const auto positive = [=](const T& x) { return (x >= smallest) & (x <= largest); };
    const Index chains = last - first;
    if (!all(part(batch.weight), chains, batch.size, positive)) return false;
    if (!all(part(batch.length), chains, batch.size, positive)) return false;
    if (!batch.centroid) return true;
    if (!all(part(*batch.centroid), chains, batch.size, positive)) return false;
    if (batch.radius_of_gyration)
        return all(part(*batch.radius_of_gyration), chains, batch.size,
                   [=](const T& x) { return (x >= T(0)) & (x <= largest); });
    if (!all(part(*batch.pendulum_length), chains, batch.size, positive)) return false;
    const BatchColumn<T>& h = *batch.centroid;
    const BatchColumn<T>& l = *batch.pendulum_length;
    const bool one_row = h.chain_stride == 0 && l.chain_stride == 0;
    bool real = true;
    for (Index c = first; c < (one_row ? std::min(last, first + 1) : last); ++c)
        for (Index m = 0; m < batch.size; ++m) real &= h(c, m) <= l(c, m);
    return real;
}

/// What a batch is found to be before anything is computed.
struct BatchPlan {
    Index count = 0;           ///< modes of each chain
    std::vector<Index> alone;  ///< chains not for the lanes, ascending
};

template <Real T>
void check(const ChainBatch<T>& batch, const BatchOptions& options) {
    constexpr std::string_view place = "conical_heights";
    if (batch.chains < 0) refuse(place, "the number of chains must not be negative", batch.chains);
    if (batch.size < 1) refuse(place, "a chain needs at least one link", batch.size);
    if (!batch.centroid && (batch.pendulum_length || batch.radius_of_gyration))
        refuse(place, "pendulum_length and radius_of_gyration need the centroid");
    if (batch.centroid && batch.pendulum_length.has_value() == batch.radius_of_gyration.has_value())
        refuse(place, "a centroid needs either pendulum_length or radius_of_gyration (not both)");
    if (options.count && *options.count < 1) refuse(place, "count must be at least 1", *options.count);
    if (options.count && *options.count > batch.size)
        refuse(place, "count must not exceed the " + std::to_string(batch.size) + " links of a chain", *options.count);
    if (options.threads < 1) refuse(place, "threads must be at least 1", options.threads);
}

/// Throws InvalidArgument for the first chain that has something wrong.
template <Real T>
BatchPlan look_at_each(const ChainBatch<T>& batch, const BatchOptions& options) {
    BatchPlan plan{options.count.value_or(batch.size), {}};
    constexpr Index together = 64;
    Index fewest = batch.size, which = 0;
    for (Index first = 0; first < batch.chains; first += together) {
        const Index last = std::min(first + together, batch.chains);
        if (ordinary(batch, first, last)) continue;
        for (Index c = first; c < last; ++c) {
            if (ordinary(batch, c, c + 1)) continue;
            const Index modes = chain_of(batch, c).mode_count();
            plan.alone.push_back(c);
            if (modes < fewest) {
                fewest = modes;
                which = c;
            }
        }
    }
    // All alike: that many modes. Unlike: the caller has to say how many of each.
    const bool alike = static_cast<Index>(plan.alone.size()) == batch.chains &&
                       std::all_of(plan.alone.begin(), plan.alone.end(),
                                   [&](Index c) { return chain_of(batch, c).mode_count() == fewest; });
    if (!options.count && alike) plan.count = fewest;
    if (plan.count > fewest)
        refuse(
            "conical_heights",
            name_of_chain(batch, which) + " has only " + std::to_string(fewest) + " modes; count must not exceed them",
            plan.count);
    return plan;
}

}  // namespace revchain::detail
