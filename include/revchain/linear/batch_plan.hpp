// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "revchain/chain.hpp"

namespace revchain::inline REVCHAIN_BUILD {

// These types are declared in revchain/batch.hpp.
template <Real T>
struct BatchColumn;
template <Real T>
struct ChainBatch;

}  // namespace revchain

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Returns "chain 17", counted from 0, or "chain (4, 2)" if the batch has several axes.
template <Real T>
std::string name_of_chain(const ChainBatch<T>& batch, Index chain) {
    if (batch.shape.size() < 2) return "chain " + std::to_string(chain);
    std::string name;
    for (std::size_t axis = batch.shape.size(); axis-- > 0; chain /= batch.shape[axis])
        name = std::to_string(chain % batch.shape[axis]) + (name.empty() ? "" : ", ") + name;
    return "chain (" + name + ")";
}

template <Real T>
Link<T> link_of(const ChainBatch<T>& batch, Index c, Index m) {
    Link<T> link = plummet(batch.weight(c, m), batch.length(c, m));
    if (!batch.centroid) return link;
    const std::string place = "Chain: links[" + std::to_string(m) + "]";
    link.centroid = (*batch.centroid)(c, m);
    const T a = link.length, h = link.centroid;
    link.gyration_ratio =
        batch.pendulum_length
            ? gyration_from_pendulum_length<T>(place, a, h, (*batch.pendulum_length)(c, m))
            : gyration_from_radius<T>(place, a, (*batch.radius_of_gyration)(c, m));
    return link;
}

/// Returns chain number c, checked like every Chain. An error message names the chain.
template <Real T>
Chain<T> chain_of(const ChainBatch<T>& batch, Index c) {
    try {
        std::vector<Link<T>> links;
        links.reserve(static_cast<std::size_t>(batch.size));
        for (Index m = 0; m < batch.size; ++m) links.push_back(link_of(batch, c, m));
        return Chain<T>(links);
    } catch (const InvalidArgument& wrong) {
        const std::string_view sentence(wrong.what());
        const std::string_view prefix("revchain::Chain: ");
        const auto rest = sentence.substr(sentence.starts_with(prefix) ? prefix.size() : 0);
        throw_invalid("conical_heights", name_of_chain(batch, c) + ": " + std::string(rest));
    }
}

/// Returns true if good(x) for every stored number. It is vectorised because it has no branch.
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

/// Returns true if the lanes support chains `first` ... `last` - 1: weights, lengths and centroids
/// are positive and not extreme, radii of gyration real. Such chains have as many modes as links.
template <Real T>
bool ordinary(const ChainBatch<T>& batch, Index first, Index last) {
    const auto part = [&](BatchColumn<T> column) {
        column.data += first * column.chain_stride;
        return column;
    };
    using std::ldexp;
    const T largest = ldexp(T(1), std::numeric_limits<T>::max_exponent * 2 / 5),
            smallest = T(1) / largest;
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

struct BatchPlan {
    Index count = 0;           ///< modes of each chain
    std::vector<Index> alone;  ///< chains that lanes do not support, ascending
};

/// Returns the plan of a batch. Throws InvalidArgument for the first chain that is not valid, and
/// for a `count` above the fewest modes of a chain.
template <Real T>
BatchPlan classify(const ChainBatch<T>& batch, const std::optional<Index>& count) {
    BatchPlan plan{count.value_or(batch.size), {}};
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
    // If chains differ in their number of modes, the caller must say how many to compute.
    const bool alike = static_cast<Index>(plan.alone.size()) == batch.chains &&
                       std::all_of(plan.alone.begin(), plan.alone.end(), [&](Index c) {
                           return chain_of(batch, c).mode_count() == fewest;
                       });
    if (!count && alike) plan.count = fewest;
    if (plan.count > fewest)
        throw_invalid("conical_heights",
                      name_of_chain(batch, which) + " has only " + std::to_string(fewest) +
                          " modes; count must not exceed them",
                      plan.count);
    return plan;
}

}  // namespace revchain::detail
