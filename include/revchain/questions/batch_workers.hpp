// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include "revchain/linear/batch_plan.hpp"
#include "revchain/modes.hpp"
#include "revchain/pencil/batch/spectrum.hpp"

namespace revchain::inline REVCHAIN_BUILD::detail {

/// Computes the heights of one chain by `modes`. The chain may be any valid one; every height is
/// proved.
template <Real T>
void heights_alone(const ChainBatch<T>& batch, Index c, Index count, Table<T>& heights) {
    using std::sqrt;
    const Modes<T> m = modes(chain_of(batch, c), {.count = count});
    if (!(m.error_bound.maxCoeff() < sqrt(epsilon<T>())))
        throw_invalid("conical_heights",
                      name_of_chain(batch, c) +
                          ": its heights cannot be proved in this scalar; the error bound is",
                      m.error_bound.maxCoeff());
    heights.row(c) = m.conical_height.transpose();
}

template <class T>
inline constexpr bool fits_lanes = std::is_same_v<T, double> || std::is_same_v<T, float>;

/// Solves chains of a batch, `block_lanes` at a time, or one by one if the scalar does not fit the
/// lanes.
template <Real T>
class BatchWorker {
   public:
    BatchWorker(const ChainBatch<T>& batch, const BatchPlan& plan, Table<T>& heights)
        : batch_(batch),
          plan_(plan),
          heights_(heights),
          raw_(static_cast<std::size_t>(4 * batch.size * pencil::block_lanes)),
          found_(static_cast<std::size_t>(plan.count * pencil::block_lanes)),
          work_(pencil::lane_work(batch.size)) {}

    void run(Index first, Index last) {
        auto alone = std::lower_bound(plan_.alone.begin(), plan_.alone.end(), first);
        for (Index c = first; c < last; ++c) {
            const bool is_alone = alone != plan_.alone.end() && *alone == c;
            if (is_alone) ++alone;
            if (is_alone || !fits_lanes<T>)
                heights_alone(batch_, c, plan_.count, heights_);
            else if constexpr (fits_lanes<T>)
                take(c, first_method());
        }
    }

    /// Solves the waiting chains, then again those whose heights could not be proved at first.
    void finish(Progress* progress) {
        if constexpr (fits_lanes<T>) {
            solve(first_method());
            std::vector<Index> again;
            again.swap(unproved_);
            if (first_method() == pencil::LaneMethod::coefficients) {
                for (const Index c : again) take(c, pencil::LaneMethod::recurrence);
                solve(pencil::LaneMethod::recurrence);
                again.swap(unproved_);
            }
            for (const Index c : again) {
                heights_alone(batch_, c, plan_.count, heights_);
                advance(progress, 1.0);
            }
        }
    }

   private:
    pencil::LaneMethod first_method() const {
        using enum pencil::LaneMethod;
        return batch_.size <= 16 ? coefficients : recurrence;
    }

    void take(Index c, pencil::LaneMethod method) {
        chains_[static_cast<std::size_t>(waiting_)] = c;
        copy(batch_.weight, c, 0);
        copy(batch_.length, c, 1);
        if (batch_.centroid) copy(*batch_.centroid, c, 2);
        if (batch_.pendulum_length) copy(*batch_.pendulum_length, c, 3);
        if (batch_.radius_of_gyration) copy(*batch_.radius_of_gyration, c, 3);
        if (++waiting_ == pencil::block_lanes) solve(method);
    }

    void copy(const BatchColumn<T>& column, Index c, Index which) {
        const T* from = column.data + c * column.chain_stride;
        double* to = raw_.data() + which * batch_.size * pencil::block_lanes + waiting_;
        for (Index m = 0; m < batch_.size;
             ++m, from += column.link_stride, to += pencil::block_lanes)
            *to = static_cast<double>(*from);
    }

    /// Solves the waiting chains. Empty lanes get a copy of the first chain; their results are not
    /// read.
    void solve(pencil::LaneMethod method) {
        if (waiting_ == 0) return;
        const Index column = batch_.size * pencil::block_lanes;
        for (Index row = 0; row < 4 * batch_.size && waiting_ < pencil::block_lanes; ++row) {
            double* const lanes = raw_.data() + row * pencil::block_lanes;
            std::fill(lanes + waiting_, lanes + pencil::block_lanes, lanes[0]);
        }
        const double* const raw = raw_.data();
        const pencil::LaneBlock block{
            batch_.size,      raw,
            raw + column,     batch_.centroid ? raw + 2 * column : nullptr,
            raw + 3 * column, batch_.radius_of_gyration.has_value()};
        std::array<std::int64_t, pencil::block_lanes> verified{};
        pencil::lane_spectrum(block, plan_.count, method, work_.data(), found_.data(),
                              verified.data());
        for (Index i = 0; i < waiting_; ++i) {
            const Index c = chains_[static_cast<std::size_t>(i)];
            const double* const found = found_.data() + i;
            const double least = found[(plan_.count - 1) * pencil::block_lanes];
            if (verified[static_cast<std::size_t>(i)] == 0 ||
                !(least >= static_cast<double>(std::numeric_limits<T>::min()))) {
                unproved_.push_back(c);
                continue;
            }
            T* const to = heights_.data() + c * plan_.count;
            for (Index j = 0; j < plan_.count; ++j)
                to[j] = static_cast<T>(found[j * pencil::block_lanes]);
        }
        waiting_ = 0;
    }

    const ChainBatch<T>& batch_;
    const BatchPlan& plan_;
    Table<T>& heights_;
    std::vector<double> raw_, found_, work_;
    std::array<Index, pencil::block_lanes> chains_{};
    Index waiting_ = 0;
    std::vector<Index> unproved_;
};

}  // namespace revchain::detail
