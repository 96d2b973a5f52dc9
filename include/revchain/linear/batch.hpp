// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "revchain/linear/modes.hpp"
#if defined(__GNUC__)
#include "revchain/linalg/lane_spectrum.hpp"
#endif

namespace revchain {

/// One quantity of all links of all chains: that of link m (lowest first) of chain c at data[c chain_stride + m
/// link_stride]. A stride of 0 repeats a number.
template <Real T>
struct BatchColumn {
    const T* data = nullptr;
    Index chain_stride = 0;
    Index link_stride = 0;

    const T& operator()(Index chain, Index link) const { return data[chain * chain_stride + link * link_stride]; }
};

/// Many chains of equally many links. Without a centroid plummets; with one exactly one of the two that follow it.
template <Real T>
struct ChainBatch {
    Index chains = 0;
    Index size = 0;  ///< links of each chain
    BatchColumn<T> weight;
    BatchColumn<T> length;
    std::optional<BatchColumn<T>> centroid{};
    std::optional<BatchColumn<T>> pendulum_length{};
    std::optional<BatchColumn<T>> radius_of_gyration{};
    std::vector<Index> shape{};  ///< axes over which the chains are spread, last fastest; only to name a chain
};

struct BatchOptions {
    std::optional<Index> count{};  ///< the slowest so many modes of each chain; absent: all
    Index threads = 1;
    Progress* progress = nullptr;  ///< watched and stopped from another thread
};

namespace detail {

/// "chain 17" (counted from 0), "chain (4, 2)" where the batch has several axes.
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
    const std::string place = "Chain: link " + std::to_string(m + 1);
    link.centroid = (*batch.centroid)(c, m);
    link.gyration_ratio =
        batch.pendulum_length
            ? gyration_from_pendulum_length<T>(place, link.length, link.centroid, (*batch.pendulum_length)(c, m))
            : gyration_from_radius<T>(place, link.length, (*batch.radius_of_gyration)(c, m));
    return link;
}

/// Chain number c, checked as every Chain is; what is wrong with it is told with its number.
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
        refuse("conical_heights", name_of_chain(batch, c) + ": " +
                                      std::string(sentence.substr(sentence.starts_with(prefix) ? prefix.size() : 0)));
    }
}

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

/// One chain by itself, by `modes`: any valid chain, every height proved.
template <Real T>
void heights_alone(const ChainBatch<T>& batch, Index c, Index count, Table<T>& heights) {
    using std::sqrt;
    const Modes<T> m = modes(chain_of(batch, c), {.count = count, .shapes = false});
    if (!(m.error_bound.maxCoeff() < sqrt(epsilon<T>())))
        refuse("conical_heights",
               name_of_chain(batch, c) + ": its heights cannot be proved in this scalar; the error bound is",
               m.error_bound.maxCoeff());
    heights.row(c) = m.conical_height.transpose();
}

#if defined(__GNUC__)
template <class T>
inline constexpr bool fits_lanes = std::is_same_v<T, double> || std::is_same_v<T, float>;

/// The chains first ... last - 1 of a batch, `block_lanes` at a time.
template <Real T>
class LaneWorker {
   public:
    LaneWorker(const ChainBatch<T>& batch, const BatchPlan& plan, Table<T>& heights)
        : batch_(batch),
          plan_(plan),
          heights_(heights),
          raw_(static_cast<std::size_t>(4 * batch.size * linalg::block_lanes)),
          found_(static_cast<std::size_t>(plan.count * linalg::block_lanes)),
          work_(linalg::lane_work(batch.size)) {}

    void run(Index first, Index last) {
        auto alone = std::lower_bound(plan_.alone.begin(), plan_.alone.end(), first);
        for (Index c = first; c < last; ++c) {
            if (alone != plan_.alone.end() && *alone == c) {
                heights_alone(batch_, c, plan_.count, heights_);
                ++alone;
            } else {
                take(c, first_method());
            }
        }
    }

    /// What could not be proved at once.
    void finish(Progress* progress) {
        solve(first_method());
        std::vector<Index> again;
        again.swap(unproved_);
        if (first_method() == linalg::LaneMethod::coefficients) {
            for (const Index c : again) take(c, linalg::LaneMethod::recurrence);
            solve(linalg::LaneMethod::recurrence);
            again.swap(unproved_);
        }
        for (const Index c : again) {
            heights_alone(batch_, c, plan_.count, heights_);
            advance(progress, 1.0);
        }
    }

   private:
    linalg::LaneMethod first_method() const {
        return batch_.size <= 16 ? linalg::LaneMethod::coefficients : linalg::LaneMethod::recurrence;
    }

    void take(Index c, linalg::LaneMethod method) {
        chains_[static_cast<std::size_t>(waiting_)] = c;
        copy(batch_.weight, c, 0);
        copy(batch_.length, c, 1);
        if (batch_.centroid) copy(*batch_.centroid, c, 2);
        if (batch_.pendulum_length) copy(*batch_.pendulum_length, c, 3);
        if (batch_.radius_of_gyration) copy(*batch_.radius_of_gyration, c, 3);
        if (++waiting_ == linalg::block_lanes) solve(method);
    }

    void copy(const BatchColumn<T>& column, Index c, Index which) {
        const T* from = column.data + c * column.chain_stride;
        double* to = raw_.data() + which * batch_.size * linalg::block_lanes + waiting_;
        for (Index m = 0; m < batch_.size; ++m, from += column.link_stride, to += linalg::block_lanes)
            *to = static_cast<double>(*from);
    }

    /// Empty lanes get a chain that is there: nothing they compute is read.
    void solve(linalg::LaneMethod method) {
        if (waiting_ == 0) return;
        const Index column = batch_.size * linalg::block_lanes;
        for (Index row = 0; row < 4 * batch_.size && waiting_ < linalg::block_lanes; ++row) {
            double* const lanes = raw_.data() + row * linalg::block_lanes;
            std::fill(lanes + waiting_, lanes + linalg::block_lanes, lanes[0]);
        }
        const double* const raw = raw_.data();
        const linalg::LaneBlock block{batch_.size,      raw,
                                      raw + column,     batch_.centroid ? raw + 2 * column : nullptr,
                                      raw + 3 * column, batch_.radius_of_gyration.has_value()};
        std::array<std::int64_t, linalg::block_lanes> verified{};
        linalg::lane_spectrum(block, plan_.count, method, work_.data(), found_.data(), verified.data());
        for (Index i = 0; i < waiting_; ++i) {
            const Index c = chains_[static_cast<std::size_t>(i)];
            const double* const found = found_.data() + i;
            const double least = found[(plan_.count - 1) * linalg::block_lanes];
            if (verified[static_cast<std::size_t>(i)] == 0 ||
                !(least >= static_cast<double>(std::numeric_limits<T>::min()))) {
                unproved_.push_back(c);
                continue;
            }
            T* const to = heights_.data() + c * plan_.count;
            for (Index j = 0; j < plan_.count; ++j) to[j] = static_cast<T>(found[j * linalg::block_lanes]);
        }
        waiting_ = 0;
    }

    const ChainBatch<T>& batch_;
    const BatchPlan& plan_;
    Table<T>& heights_;
    std::vector<double> raw_, found_, work_;
    std::array<Index, linalg::block_lanes> chains_{};
    Index waiting_ = 0;
    std::vector<Index> unproved_;
};
#else
template <class T>
inline constexpr bool fits_lanes = false;

template <Real T>
class LaneWorker {};
#endif

/// One chain after the other.
template <Real T>
class SingleWorker {
   public:
    SingleWorker(const ChainBatch<T>& batch, const BatchPlan& plan, Table<T>& heights)
        : batch_(batch), plan_(plan), heights_(heights) {}
    void run(Index first, Index last) {
        for (Index c = first; c < last; ++c) heights_alone(batch_, c, plan_.count, heights_);
    }
    void finish(Progress*) {}

   private:
    const ChainBatch<T>& batch_;
    const BatchPlan& plan_;
    Table<T>& heights_;
};

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
    part(0);
    for (auto& other : others) other.get();
    return !unusual;
}

}  // namespace detail

/// The slowest `count` conical heights of every chain of a batch, descending: a row for each chain, in its unit of
/// length. Greenhill (1908) §8 (21) with sec delta = 1.
///
/// In float and double one chain to a SIMD lane (linalg/lane_spectrum.hpp); chains for which that proves nothing, those
/// with massless links or centroids at or above the pin, and all chains in other scalars are done one by one by `modes`.
/// Accuracy: 2.7 ulp for plummets and rods up to N = 100; in a million chains of all kinds of 1 to 6 links 29 heights were
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
